//! What is known about every pair of bodies: how long they are surely apart, and which parts touch.

use glam::DVec3;

use super::touch::Touch;

/// Two parts of two bodies.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PartPair {
    pub part_a: u8,
    pub part_b: u8,
    /// Normal of the last search; zero before the first.
    pub normal: DVec3,
    /// Gap plus the ways of both bodies when it was measured [m]: they are apart until their ways have used it up.
    pub clearance: f64,
    pub touching: bool,
    /// The contact as it was when the two bodies' ways were these: as long as neither moves it stays so.
    pub seen: Option<(f64, f64, Touch)>,
}

/// Two bodies, `a < b`.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pair {
    pub clearance: f64,
    pub parts: Vec<PartPair>,
}

/// A touching contact: two bodies and the index among their pairs of parts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Key {
    pub a: u32,
    pub b: u32,
    pub part: u32,
}

/// Triangular table of pairs, and the list of touching contacts in the order in which they formed.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pairs {
    table: Vec<Pair>,
    pub touching: Vec<Key>,
}

impl Pairs {
    fn index(a: usize, b: usize) -> usize {
        let (low, high) = if a < b { (a, b) } else { (b, a) };
        high * (high - 1) / 2 + low
    }

    pub fn get(&self, a: usize, b: usize) -> &Pair {
        &self.table[Pairs::index(a, b)]
    }

    pub fn get_mut(&mut self, a: usize, b: usize) -> &mut Pair {
        &mut self.table[Pairs::index(a, b)]
    }

    pub fn part(&self, key: Key) -> &PartPair {
        &self.get(key.a as usize, key.b as usize).parts[key.part as usize]
    }

    pub fn part_mut(&mut self, key: Key) -> &mut PartPair {
        &mut self.get_mut(key.a as usize, key.b as usize).parts[key.part as usize]
    }

    /// Drops all that is known about a body, and makes room for `count` bodies.
    pub fn forget(&mut self, slot: usize, count: usize) {
        self.table
            .resize(count * count.saturating_sub(1) / 2, Pair::default());
        for other in (0..count).filter(|o| *o != slot) {
            *self.get_mut(slot, other) = Pair {
                clearance: f64::NEG_INFINITY,
                parts: Vec::new(),
            };
        }
        self.touching
            .retain(|k| k.a as usize != slot && k.b as usize != slot);
    }

    pub fn any_touching(&self, a: usize, b: usize) -> bool {
        a != b && self.get(a, b).parts.iter().any(|p| p.touching)
    }

    pub fn set_touching(&mut self, key: Key, on: bool) {
        let part = self.part_mut(key);
        if part.touching == on {
            return;
        }
        part.touching = on;
        if on {
            self.touching.push(key);
        } else {
            self.touching.retain(|k| *k != key);
        }
    }
}
