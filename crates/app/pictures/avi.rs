//! Writes motion-JPEG video in an AVI file, which every player opens, with a sound track where there is one.
//!
//! Layout: Microsoft, *AVI RIFF File Reference*: `RIFF AVI ( LIST hdrl, LIST movi, idx1 )`, one
//! stream of compressed frames (`00dc`), each a complete JPEG, and one of PCM samples (`01wb`), each chunk those of the
//! picture before it. All numbers little-endian.

use std::io::{self, Seek, SeekFrom, Write};

use image::RgbImage;
use image::codecs::jpeg::JpegEncoder;
use sound::wav::{pcm16, pcm16_format};

/// JPEG quality, 1 to 100: at 80 a lane seen from the foul line shows no blocks.
const QUALITY: u8 = 80;
/// Bytes from the start of the file to the word `movi`, where index offsets start, without and with a sound track.
const MOVI_START: [u64; 2] = [220, 320];
/// Bytes of one sample of both ears.
const SAMPLE_BYTES: u32 = 4;
/// AVIF_HASINDEX: the file ends in an index, so that players can seek.
const HAS_INDEX: u32 = 0x10;
/// AVIIF_KEYFRAME: every frame of motion JPEG stands alone.
const KEY_FRAME: u32 = 0x10;

/// A video being written, frame by frame.
pub struct AviWriter<W: Write + Seek> {
    file: W,
    width: u32,
    height: u32,
    frames_per_second: u32,
    /// Samples per second of the sound track [Hz]; `None` without one.
    sample_rate: Option<u32>,
    /// Name, offset from `movi` and length of every chunk [bytes].
    index: Vec<(&'static [u8; 4], u32, u32)>,
    pictures: u32,
    samples: u32,
    largest_frame: u32,
    largest_sound: u32,
    position: u64,
}

impl<W: Write + Seek> AviWriter<W> {
    /// Starts a video of `width` by `height` pixels at the start of `file`, with a stereo track where there is a
    /// `sample_rate` [Hz].
    ///
    /// # Errors
    /// When `file` cannot be written.
    pub fn new(
        file: W,
        (width, height): (u32, u32),
        frames_per_second: u32,
        sample_rate: Option<u32>,
    ) -> io::Result<Self> {
        let mut writer = AviWriter {
            file,
            width,
            height,
            frames_per_second,
            sample_rate,
            index: Vec::new(),
            pictures: 0,
            samples: 0,
            largest_frame: 0,
            largest_sound: 0,
            position: MOVI_START[usize::from(sample_rate.is_some())] + 4,
        };
        // The sizes are not known yet: `finish` writes the same bytes again, filled in.
        let header = writer.header(0);
        writer.file.write_all(&header)?;
        Ok(writer)
    }

    /// Appends one picture, which must have the video's size.
    ///
    /// # Errors
    /// When the file cannot be written, the size is wrong, or the file would pass 4 GB.
    pub fn push(&mut self, picture: &RgbImage) -> io::Result<()> {
        if picture.dimensions() != (self.width, self.height) {
            return Err(io::Error::other(
                "a picture of the wrong size was given to the video",
            ));
        }
        let mut jpeg = Vec::new();
        JpegEncoder::new_with_quality(&mut jpeg, QUALITY)
            .encode_image(picture)
            .map_err(io::Error::other)?;
        self.largest_frame = self.largest_frame.max(jpeg.len() as u32);
        self.pictures += 1;
        self.chunk(b"00dc", &jpeg)
    }

    /// Appends the samples that are heard while the last picture is seen, left ear first.
    ///
    /// # Errors
    /// When the file cannot be written, has no sound track, or would pass 4 GB.
    pub fn push_sound(&mut self, samples: &[[f32; 2]]) -> io::Result<()> {
        if self.sample_rate.is_none() {
            return Err(io::Error::other(
                "sound was given to a video without a sound track",
            ));
        }
        let data = pcm16(samples);
        self.largest_sound = self.largest_sound.max(data.len() as u32);
        self.samples += samples.len() as u32;
        self.chunk(b"01wb", &data)
    }

    fn chunk(&mut self, name: &'static [u8; 4], data: &[u8]) -> io::Result<()> {
        let length = u32::try_from(data.len()).map_err(io::Error::other)?;
        let offset = u32::try_from(self.position - self.movi_start())
            .map_err(|_| io::Error::other("an AVI file holds at most 4 GB"))?;
        self.file.write_all(name)?;
        self.file.write_all(&length.to_le_bytes())?;
        self.file.write_all(data)?;
        // Chunks start at even bytes.
        if data.len() % 2 == 1 {
            self.file.write_all(&[0])?;
        }
        self.index.push((name, offset, length));
        self.position += 8 + u64::from(length) + u64::from(length % 2);
        Ok(())
    }

    fn movi_start(&self) -> u64 {
        MOVI_START[usize::from(self.sample_rate.is_some())]
    }

    /// Writes index and sizes; the file is a video only after this.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn finish(mut self) -> io::Result<W> {
        let movi_bytes =
            u32::try_from(self.position - self.movi_start()).map_err(io::Error::other)?;
        let mut index = Vec::with_capacity(8 + 16 * self.index.len());
        index.extend(b"idx1");
        index.extend((16 * self.index.len() as u32).to_le_bytes());
        for (name, offset, length) in &self.index {
            index.extend(*name);
            for number in [KEY_FRAME, *offset, *length] {
                index.extend(number.to_le_bytes());
            }
        }
        self.file.write_all(&index)?;
        let header = self.header(movi_bytes);
        self.file.seek(SeekFrom::Start(0))?;
        self.file.write_all(&header)?;
        self.file.flush()?;
        Ok(self.file)
    }

    /// Everything before the first frame; `movi_bytes` counts from the word `movi` on.
    fn header(&self, movi_bytes: u32) -> Vec<u8> {
        let index_bytes = 8 + 16 * self.index.len() as u32;
        let mut parts = vec![chunk(b"avih", &self.main_header())];
        let pictures = [
            chunk(b"strh", &self.picture_stream()),
            chunk(b"strf", &self.picture_format()),
        ];
        parts.push(list(b"strl", &pictures));
        if let Some(rate) = self.sample_rate {
            let sound = [
                chunk(b"strh", &self.sound_stream(rate)),
                chunk(b"strf", &pcm16_format(rate)),
            ];
            parts.push(list(b"strl", &sound));
        }
        let headers = list(b"hdrl", &parts);
        let movi_start = self.movi_start() as u32;
        let mut bytes = Vec::with_capacity(movi_start as usize + 4);
        bytes.extend(b"RIFF");
        bytes.extend((movi_start - 8 + movi_bytes + index_bytes).to_le_bytes());
        bytes.extend(b"AVI ");
        bytes.extend(headers);
        bytes.extend(b"LIST");
        bytes.extend(movi_bytes.to_le_bytes());
        bytes.extend(b"movi");
        bytes
    }

    /// AVIMAINHEADER.
    fn main_header(&self) -> Vec<u8> {
        numbers(&[
            1_000_000 / self.frames_per_second,
            self.largest_frame.saturating_mul(self.frames_per_second),
            0,
            HAS_INDEX,
            self.pictures,
            0,
            1 + u32::from(self.sample_rate.is_some()),
            self.largest_frame,
            self.width,
            self.height,
            0,
            0,
            0,
            0,
        ])
    }

    /// AVISTREAMHEADER of the pictures.
    fn picture_stream(&self) -> Vec<u8> {
        // Flags, priority and language, initial frames, scale, rate, start, length, buffer,
        // quality (u32::MAX: the codec's own), sample size (0: each frame differs).
        let timing = [
            0,
            0,
            0,
            1,
            self.frames_per_second,
            0,
            self.pictures,
            self.largest_frame,
            u32::MAX,
            0,
        ];
        let mut bytes = b"vidsMJPG".to_vec();
        bytes.extend(numbers(&timing));
        for edge in [0, 0, self.width as u16, self.height as u16] {
            bytes.extend(edge.to_le_bytes());
        }
        bytes
    }

    /// AVISTREAMHEADER of the sound: scale and rate in bytes, the sample size is constant.
    fn sound_stream(&self, rate: u32) -> Vec<u8> {
        let timing = [
            0,
            0,
            0,
            SAMPLE_BYTES,
            rate * SAMPLE_BYTES,
            0,
            self.samples,
            self.largest_sound,
            u32::MAX,
            SAMPLE_BYTES,
        ];
        let mut bytes = b"auds\0\0\0\0".to_vec();
        bytes.extend(numbers(&timing));
        bytes.extend([0; 8]);
        bytes
    }

    /// BITMAPINFOHEADER.
    fn picture_format(&self) -> Vec<u8> {
        let picture_bytes = self.width.saturating_mul(self.height).saturating_mul(3);
        // One plane, 24 bits per pixel.
        let planes_and_bits = 1 | 24 << 16;
        let mut bytes = numbers(&[40, self.width, self.height, planes_and_bits]);
        bytes.extend(b"MJPG");
        bytes.extend(numbers(&[picture_bytes, 0, 0, 0, 0]));
        bytes
    }
}

fn numbers(values: &[u32]) -> Vec<u8> {
    values.iter().copied().flat_map(u32::to_le_bytes).collect()
}

/// A RIFF chunk: name, length, contents.
fn chunk(name: &[u8; 4], contents: &[u8]) -> Vec<u8> {
    let length = contents.len() as u32;
    [name, &length.to_le_bytes()[..], contents].concat()
}

/// A RIFF list of chunks.
fn list(name: &[u8; 4], chunks: &[Vec<u8>]) -> Vec<u8> {
    chunk(b"LIST", &[&name[..], &chunks.concat()].concat())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Cursor;

    fn video(frames: u8) -> Vec<u8> {
        let memory = Cursor::new(Vec::new());
        let mut writer = AviWriter::new(memory, (48, 32), 15, None).expect("memory");
        for frame in 0..frames {
            let picture = RgbImage::from_fn(48, 32, |x, y| {
                image::Rgb([x as u8 * 5, y as u8 * 7, frame * 40])
            });
            writer.push(&picture).expect("memory");
        }
        writer.finish().expect("memory").into_inner()
    }

    fn number(bytes: &[u8], at: usize) -> usize {
        u32::from_le_bytes(bytes[at..at + 4].try_into().expect("four bytes")) as usize
    }

    #[test]
    fn finish_fills_in_sizes_that_cover_the_file_exactly() {
        let bytes = video(5);
        assert_eq!(&bytes[..4], b"RIFF");
        assert_eq!(number(&bytes, 4) + 8, bytes.len());
        let movi = MOVI_START[0] as usize;
        assert_eq!(&bytes[movi..movi + 4], b"movi");
        let index = movi + number(&bytes, movi - 4);
        assert_eq!(&bytes[index..index + 4], b"idx1");
        assert_eq!(index + 8 + number(&bytes, index + 4), bytes.len());
    }

    #[test]
    fn every_index_entry_points_at_a_decodable_frame() {
        let bytes = video(5);
        let movi = MOVI_START[0] as usize;
        let index = movi + number(&bytes, movi - 4) + 8;
        for frame in 0..5 {
            let entry = index + 16 * frame;
            let (offset, length) = (movi + number(&bytes, entry + 8), number(&bytes, entry + 12));
            assert_eq!(&bytes[offset..offset + 4], b"00dc");
            assert_eq!(number(&bytes, offset + 4), length);
            let jpeg = &bytes[offset + 8..offset + 8 + length];
            let picture = image::load_from_memory(jpeg).expect("a JPEG").to_rgb8();
            assert_eq!(picture.dimensions(), (48, 32));
            assert!(picture.get_pixel(24, 16)[2].abs_diff(frame as u8 * 40) < 12);
        }
    }

    #[test]
    fn push_refuses_a_picture_of_another_size() {
        let mut writer =
            AviWriter::new(Cursor::new(Vec::new()), (48, 32), 15, None).expect("memory");
        assert!(writer.push(&RgbImage::new(32, 48)).is_err());
        assert!(writer.push_sound(&[[0.0; 2]]).is_err());
    }

    #[test]
    fn a_sound_track_lies_between_the_pictures_and_lasts_as_long() {
        let memory = Cursor::new(Vec::new());
        let mut writer = AviWriter::new(memory, (48, 32), 15, Some(48_000)).expect("memory");
        for _ in 0..3 {
            writer.push(&RgbImage::new(48, 32)).expect("memory");
            writer.push_sound(&[[0.5, -0.5]; 3200]).expect("memory");
        }
        let bytes = writer.finish().expect("memory").into_inner();
        assert_eq!(number(&bytes, 4) + 8, bytes.len());
        let movi = MOVI_START[1] as usize;
        assert_eq!(&bytes[movi..movi + 4], b"movi");
        // Three pictures at 15 Hz take 0.2 s, as do 9600 samples at 192000 bytes a second by 4.
        let sound = bytes
            .windows(4)
            .position(|w| w == b"auds")
            .expect("a track");
        let (scale, rate, length) = (sound + 20, sound + 24, sound + 32);
        let seconds = number(&bytes, length) * number(&bytes, scale);
        assert_eq!(seconds * 5, number(&bytes, rate));
        let index = movi + number(&bytes, movi - 4) + 8;
        for (entry, name) in [b"00dc", b"01wb"].into_iter().cycle().take(6).enumerate() {
            let at = index + 16 * entry;
            assert_eq!(&bytes[at..at + 4], name);
            let chunk = movi + number(&bytes, at + 8);
            assert_eq!(&bytes[chunk..chunk + 4], name);
        }
        // 0.5 of 32767, rounded to even, and its opposite.
        let first = movi + number(&bytes, index + 16 + 8) + 8;
        assert_eq!(bytes[first..first + 4], [0x00, 0x40, 0x00, 0xc0]);
    }
}
