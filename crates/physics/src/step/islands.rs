//! Islands: bodies that lasting contacts join, answered one island after the other.
//!
//! What an island needs fits in the processor's nearest cache however many lanes a world has; all contacts of 256
//! lanes in one list do not.

use super::pairs::Contact;
use super::touch::Touch;
use crate::world::World;

/// Who belongs to which island; an island is named by its lowest body.
#[derive(Debug, Default)]
pub(crate) struct Islands {
    /// Of each body, another of its island with a lower number, or itself.
    lower: Vec<u32>,
    /// Islands with their contacts, by age, and with the bodies that are carried.
    contacts: Vec<(u32, Contact)>,
    bodies: Vec<(u32, u32)>,
}

impl Islands {
    /// Sorts contacts and carried bodies by island; what `moves` is not true of joins nothing.
    fn sort(&mut self, lasting: &[Contact], carried: &[u32], moves: impl Fn(u32) -> bool) {
        let highest = lasting.iter().map(|c| c.key.a.max(c.key.b));
        let count = highest.chain(carried.iter().copied()).max();
        let count = count.map_or(0, |slot| slot as usize + 1);
        self.lower.resize(count.max(self.lower.len()), 0);
        let ends = lasting.iter().flat_map(|c| [c.key.a, c.key.b]);
        for slot in ends.chain(carried.iter().copied()) {
            self.lower[slot as usize] = slot;
        }
        for Contact { key, .. } in lasting {
            if moves(key.a) && moves(key.b) {
                let (a, b) = (self.lowest(key.a), self.lowest(key.b));
                self.lower[a.max(b) as usize] = a.min(b);
            }
        }
        for contact in lasting {
            let key = contact.key;
            let island = self.lowest(if moves(key.a) { key.a } else { key.b });
            self.contacts.push((island, *contact));
        }
        for slot in carried {
            let island = self.lowest(*slot);
            self.bodies.push((island, *slot));
        }
        self.contacts
            .sort_unstable_by_key(|(island, c)| (*island, c.formed));
        self.bodies.sort_unstable();
    }

    /// The lowest body of an island; shortens the way to it.
    fn lowest(&mut self, slot: u32) -> u32 {
        let mut i = slot as usize;
        while self.lower[i] as usize != i {
            self.lower[i] = self.lower[self.lower[i] as usize];
            i = self.lower[i] as usize;
        }
        i as u32
    }
}

impl World {
    /// Takes the bodies `carried`, with their `lasting` contacts, through a step of `dt` seconds.
    pub(crate) fn carry_islands(&mut self, lasting: &[Contact], carried: &[u32], dt: f64) {
        let mut islands = std::mem::take(&mut self.scratch.islands);
        islands.sort(lasting, carried, |slot| {
            self.bodies[slot as usize].is_dynamic()
        });
        let mut touches = std::mem::take(&mut self.scratch.touches);
        let mut slots = std::mem::take(&mut self.scratch.carried);
        let mut contacts = islands.contacts.drain(..).peekable();
        for group in islands.bodies.chunk_by(|x, y| x.0 == y.0) {
            let island = group[0].0;
            slots.extend(group.iter().map(|(_, slot)| *slot as usize));
            while let Some((_, contact)) = contacts.next_if(|(of, _)| *of == island) {
                let touch: Touch = self.touch(contact.key);
                touches.push(touch);
            }
            self.carry(&touches, &slots, 0.0, dt);
            touches.clear();
            slots.clear();
        }
        drop(contacts);
        islands.bodies.clear();
        (self.scratch.touches, self.scratch.carried) = (touches, slots);
        self.scratch.islands = islands;
    }
}

#[cfg(test)]
mod tests {
    use super::super::pairs::Key;
    use super::*;

    fn contact(formed: u64, a: u32, b: u32) -> Contact {
        let (pair, part) = (0, 0);
        let key = Key { a, b, pair, part };
        Contact { formed, key }
    }

    #[test]
    fn islands_are_joined_by_what_moves_and_keep_the_order_of_age() {
        let mut islands = Islands::default();
        // 0 is the floor; 7-5-3 hang together though the last link comes late, 4 stands alone.
        let lasting = [
            contact(2, 5, 7),
            contact(3, 0, 4),
            contact(5, 0, 3),
            contact(9, 3, 5),
        ];
        islands.sort(&lasting, &[3, 4, 5, 7], |slot| slot != 0);
        let named: Vec<_> = islands
            .contacts
            .iter()
            .map(|(i, c)| (*i, c.formed))
            .collect();
        assert_eq!(named, [(3, 2), (3, 5), (3, 9), (4, 3)]);
        assert_eq!(islands.bodies, [(3, 3), (3, 5), (3, 7), (4, 4)]);
    }
}
