//! Sound files: WAV with 16 bits.
//!
//! Layout: Microsoft and IBM, *Multimedia Programming Interface and Data Specifications 1.0*, 1991: `RIFF WAVE ( fmt , data )`,
//! all numbers little-endian.

use std::io::{self, Write};

/// Bytes of one sample of both ears.
const FRAME_BYTES: u32 = 4;

/// Both ears' samples as 16-bit numbers, left first, little-endian.
///
/// Rounded, not dithered: the same sound is the same bytes.
pub fn pcm16(samples: &[[f32; 2]]) -> Vec<u8> {
    samples
        .iter()
        .flatten()
        .flat_map(|sample| {
            let number = (sample.clamp(-1.0, 1.0) * 32_767.0).round_ties_even();
            (number as i16).to_le_bytes()
        })
        .collect()
}

/// The format that a stereo track of [`pcm16`] samples declares: PCM, 2 channels, rate, bytes per second, bytes per
/// frame, 16 bits (WAVEFORMATEX without its extension).
pub fn pcm16_format(sample_rate: u32) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(16);
    bytes.extend(1u16.to_le_bytes());
    bytes.extend(2u16.to_le_bytes());
    bytes.extend(sample_rate.to_le_bytes());
    bytes.extend((sample_rate * FRAME_BYTES).to_le_bytes());
    bytes.extend((FRAME_BYTES as u16).to_le_bytes());
    bytes.extend(16u16.to_le_bytes());
    bytes
}

/// Writes `samples` as a WAV file.
///
/// # Errors
/// When `file` cannot be written, or the sound is longer than the format holds (6 hours at 48 kHz).
pub fn write_wav(mut file: impl Write, samples: &[[f32; 2]], sample_rate: u32) -> io::Result<()> {
    let data = pcm16(samples);
    let length = u32::try_from(data.len())
        .ok()
        .filter(|length| *length < u32::MAX - 36)
        .ok_or_else(|| io::Error::other("a WAV file holds at most 4 GB"))?;
    file.write_all(b"RIFF")?;
    file.write_all(&(length + 36).to_le_bytes())?;
    file.write_all(b"WAVEfmt ")?;
    file.write_all(&16u32.to_le_bytes())?;
    file.write_all(&pcm16_format(sample_rate))?;
    file.write_all(b"data")?;
    file.write_all(&length.to_le_bytes())?;
    file.write_all(&data)?;
    file.flush()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn write_wav_writes_the_header_of_the_specification() {
        let mut file = Vec::new();
        let samples = [[0.0, 1.0], [-1.0, 0.5]];
        write_wav(&mut file, &samples, 48_000).expect("memory");
        // By hand from the specification.
        let header = b"RIFF\x2c\0\0\0WAVEfmt \x10\0\0\0\x01\0\x02\0\x80\xbb\0\0\0\xee\x02\0\x04\0\x10\0data\x08\0\0\0";
        assert_eq!(&file[..44], header);
        assert_eq!(&file[44..], [0, 0, 0xff, 0x7f, 0x01, 0x80, 0x00, 0x40]);
    }
}
