//! The same contacts make the same bits.

use sound::{Mixer, Settings, offline, wav};

use crate::strike;

fn throw_in_blocks(sizes: &[usize]) -> Vec<[f32; 2]> {
    let mut mixer = Mixer::new(&Settings::default());
    for event in strike::strike() {
        mixer.submit(event);
    }
    let mut out = vec![[0.0; 2]; 200_000];
    let mut rest = &mut out[..];
    for size in sizes.iter().cycle() {
        let (block, after) = rest.split_at_mut((*size).min(rest.len()));
        mixer.render(block);
        rest = after;
        if rest.is_empty() {
            break;
        }
    }
    out
}

fn bits(samples: &[[f32; 2]]) -> Vec<u32> {
    samples.iter().flatten().map(|x| x.to_bits()).collect()
}

#[test]
fn a_throw_is_the_same_bits_in_blocks_of_every_size_and_offline() {
    let whole = bits(&throw_in_blocks(&[200_000]));
    for sizes in [&[64][..], &[512], &[1], &[333, 7, 1021], &[31, 32, 33]] {
        assert!(bits(&throw_in_blocks(sizes)) == whole, "{sizes:?}");
    }
    let offline = offline::render(&Settings::default(), &strike::strike(), 4.2);
    assert!(bits(&offline)[..400_000] == whole);
}

#[test]
fn a_throw_is_the_same_file_twice_and_another_seed_makes_another() {
    let file = |seed| {
        let settings = Settings {
            seed,
            ..Settings::default()
        };
        let mut file = Vec::new();
        let samples = offline::render(&settings, &strike::strike(), strike::LENGTH_S);
        wav::write_wav(&mut file, &samples, 48_000).expect("memory");
        file
    };
    assert!(file(1) == file(1));
    assert!(file(1) != file(2));
}
