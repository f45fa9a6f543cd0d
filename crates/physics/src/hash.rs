//! Fingerprint of a world's state.

use crate::world::World;

/// FNV-1a, 64 bits: short, stable, and the same everywhere.
struct Fnv(u64);

impl Fnv {
    fn word(&mut self, word: u64) {
        for byte in word.to_le_bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }

    fn float(&mut self, x: f64) {
        self.word(x.to_bits());
    }
}

impl World {
    /// Hash over the step count and the bits of every body's pose and velocity; equal worlds have equal hashes.
    pub fn hash(&self) -> u64 {
        let mut fnv = Fnv(0xcbf2_9ce4_8422_2325);
        fnv.word(self.steps);
        for id in self.ids() {
            let body = self.body(id);
            fnv.word(u64::from(id.slot));
            let vectors = [body.position, body.linear, body.momentum, body.turning];
            for x in vectors.iter().flat_map(|v| v.to_array()) {
                fnv.float(x);
            }
            for x in body.rotation.to_array() {
                fnv.float(x);
            }
            fnv.word(
                u64::from(body.asleep)
                    | u64::from(body.collides) << 1
                    | u64::from(body.frozen) << 2,
            );
        }
        fnv.0
    }
}
