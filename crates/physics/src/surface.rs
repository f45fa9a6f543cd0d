//! Physical coefficients of pairs of surfaces: what the Coulomb model reads, and the other two never do.

/// What a body is covered with: a row of the table of [`PairContact`]s.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Surface(pub u8);

/// How two surfaces meet under [`Response::Coulomb`](crate::Response::Coulomb).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairContact {
    /// Newton's coefficient of restitution, 0 to 1.
    pub restitution: f64,
    /// Coulomb's coefficient of friction, 0 or more.
    pub friction: f64,
}

impl PairContact {
    /// Whether both are coefficients that a step can work with.
    pub fn is_valid(&self) -> bool {
        (0.0..=1.0).contains(&self.restitution) && self.friction >= 0.0 && self.friction.is_finite()
    }
}

/// Coefficients by pair of surfaces; pairs that are not listed share one entry.
#[derive(Clone, Debug)]
pub(crate) struct PairTable {
    /// Surfaces named so far.
    count: usize,
    /// Row by row.
    entries: Vec<PairContact>,
    other: PairContact,
}

impl PairTable {
    pub fn new(other: PairContact) -> PairTable {
        PairTable {
            count: 0,
            entries: Vec::new(),
            other,
        }
    }

    pub fn set(&mut self, a: Surface, b: Surface, pair: PairContact) {
        let (a, b) = (usize::from(a.0), usize::from(b.0));
        let count = self.count.max(a.max(b) + 1);
        let mut entries = vec![self.other; count * count];
        for row in 0..self.count {
            let old = &self.entries[row * self.count..(row + 1) * self.count];
            entries[row * count..row * count + self.count].copy_from_slice(old);
        }
        (entries[a * count + b], entries[b * count + a]) = (pair, pair);
        (self.count, self.entries) = (count, entries);
    }

    pub fn get(&self, a: Surface, b: Surface) -> PairContact {
        let (a, b) = (usize::from(a.0), usize::from(b.0));
        if a < self.count && b < self.count {
            self.entries[a * self.count + b]
        } else {
            self.other
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_are_found_either_way_round_and_others_share_one_entry() {
        let pair = |friction| PairContact {
            restitution: 0.5,
            friction,
        };
        let mut table = PairTable::new(pair(9.0));
        let [a, b, c] = [0, 3, 1].map(Surface);
        table.set(a, b, pair(1.0));
        table.set(b, b, pair(2.0));
        table.set(c, a, pair(3.0));
        let friction = |x, y| table.get(x, y).friction;
        assert_eq!((friction(a, b), friction(b, a)), (1.0, 1.0));
        assert_eq!((friction(b, b), friction(a, c)), (2.0, 3.0));
        assert_eq!((friction(c, b), friction(Surface(200), a)), (9.0, 9.0));
    }
}
