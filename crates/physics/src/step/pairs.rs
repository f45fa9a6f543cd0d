//! What is known about pairs of bodies that are near each other: how long they are surely apart, and where they touch.
//!
//! Only near pairs have an entry; who is near is found in `near.rs`. Whatever is iterated here is kept in an order
//! that the calls decide: neighbours by number, contacts in the order in which they formed.

use glam::DVec3;

use super::queue::Queue;
use super::touch::Touch;

/// No entry.
const NONE: u32 = u32::MAX;
/// Sizes of lists of parts: powers of two up to 256 x 256.
const KINDS: usize = 17;

/// Two parts of two bodies.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PartPair {
    pub part_a: u8,
    pub part_b: u8,
    pub touching: bool,
    /// Whether a flat base rocked gently on a face when the contact was last looked at.
    pub rocks: bool,
    /// Where the contact as it was last seen is kept.
    seen: u32,
    /// Normal of the last search; zero before the first.
    pub normal: DVec3,
}

/// All pairs of parts of two bodies.
#[derive(Clone, Debug, Default)]
pub(crate) struct Parts {
    list: Vec<PartPair>,
    /// Of each its gap plus the ways of both bodies when it was measured [m]: apart until the ways have used it up.
    ///
    /// In a list of its own: most looks read all of these and one or two of the others.
    pub clearances: Vec<f64>,
}

/// Two bodies, `a < b`.
#[derive(Clone, Debug)]
pub(crate) struct Pair {
    pub a: u32,
    pub b: u32,
    /// Least clearance of their parts [m].
    pub clearance: f64,
    /// Pairs of parts; empty until the bodies come within reach of each other for the first time.
    pub parts: Parts,
}

/// Two parts of a pair of bodies, and where what is known of them stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Key {
    pub a: u32,
    pub b: u32,
    pub pair: u32,
    pub part: u32,
}

impl Parts {
    /// Whether the bodies were never within reach of each other.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }
}

impl Key {
    /// The other of its two bodies.
    pub fn other(&self, slot: usize) -> usize {
        (self.a + self.b) as usize - slot
    }
}

/// A body that is near another, and their pair.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Near {
    pub other: u32,
    pub pair: u32,
}

/// A contact that lasts, with its place in the order in which contacts formed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Contact {
    pub formed: u64,
    pub key: Key,
}

/// A contact as it was when the ways of its two bodies were these [m]: as long as neither moves it stays so.
#[derive(Clone, Copy, Debug)]
struct Seen {
    ways: (f64, f64),
    touch: Touch,
    loads: [Load; 4],
}

/// Force that a point of a lasting contact carried last: where the next answer begins.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Load {
    /// Where [m], world frame.
    pub point: DVec3,
    /// Along the normal [N].
    pub pressed: f64,
    /// Across it, on a, within the cone of friction [N].
    pub rubbed: DVec3,
}

/// What a body takes part in.
#[derive(Clone, Debug)]
struct Links {
    /// Neighbours, by their number.
    near: Vec<Near>,
    /// Lasting contacts, oldest first.
    contacts: Vec<Contact>,
}

impl Links {
    /// With room for a usual neighbourhood, so that lists seldom grow while a scene runs.
    fn new() -> Links {
        Links {
            near: Vec::with_capacity(16),
            contacts: Vec::with_capacity(8),
        }
    }
}

/// Near pairs, and who waits to be looked at.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pairs {
    list: Vec<Pair>,
    free: Vec<u32>,
    links: Vec<Links>,
    formed: u64,
    seen: Vec<Seen>,
    free_seen: Vec<u32>,
    /// Emptied lists of parts, for the next pairs; each kind has room for twice as many as the kind before.
    spare: [Vec<Parts>; KINDS],
    pub queue: Queue,
}

impl Pairs {
    /// Makes room for `count` bodies.
    pub fn grow(&mut self, count: usize) {
        if self.links.len() < count {
            self.links.resize_with(count, Links::new);
        }
    }

    /// Pairs of bodies that are near each other.
    pub fn count(&self) -> usize {
        self.list.len() - self.free.len()
    }

    pub fn get(&self, pair: u32) -> &Pair {
        &self.list[pair as usize]
    }

    pub fn get_mut(&mut self, pair: u32) -> &mut Pair {
        &mut self.list[pair as usize]
    }

    pub fn part(&self, key: Key) -> &PartPair {
        &self.get(key.pair).parts.list[key.part as usize]
    }

    pub fn part_mut(&mut self, key: Key) -> &mut PartPair {
        &mut self.get_mut(key.pair).parts.list[key.part as usize]
    }

    /// Neighbours of a body, by their number.
    pub fn near(&self, slot: usize) -> &[Near] {
        &self.links[slot].near
    }

    /// Lasting contacts of a body, oldest first.
    pub fn contacts(&self, slot: usize) -> &[Contact] {
        &self.links[slot].contacts
    }

    /// Whether two bodies are neighbours.
    pub fn are_near(&self, a: usize, b: usize) -> bool {
        // Of two neighbours one may be a floor with thousands.
        let (few, other) = if self.near(a).len() <= self.near(b).len() {
            (a, b)
        } else {
            (b, a)
        };
        self.place(few, other).is_ok()
    }

    /// Makes two bodies neighbours, nothing being known of them; returns their pair.
    pub fn meet(&mut self, a: usize, b: usize) -> u32 {
        let (a, b) = (a.min(b), a.max(b));
        let entry = Pair {
            a: a as u32,
            b: b as u32,
            clearance: f64::NEG_INFINITY,
            parts: Parts::default(),
        };
        let pair = match self.free.pop() {
            Some(pair) => {
                self.list[pair as usize] = entry;
                pair
            }
            None => {
                self.list.push(entry);
                self.list.len() as u32 - 1
            }
        };
        for (slot, other) in [(a, b), (b, a)] {
            if let Err(place) = self.place(slot, other) {
                let other = other as u32;
                self.links[slot].near.insert(place, Near { other, pair });
            }
        }
        pair
    }

    /// Forgets a pair, contacts included.
    pub fn separate(&mut self, pair: u32) {
        self.queue.take_out(pair);
        let entry = &mut self.list[pair as usize];
        let (a, b) = (entry.a as usize, entry.b as usize);
        let mut parts = std::mem::take(&mut entry.parts);
        for (slot, other) in [(a, b), (b, a)] {
            if let Ok(place) = self.place(slot, other) {
                self.links[slot].near.remove(place);
            }
            if parts.list.iter().any(|part| part.touching) {
                self.links[slot].contacts.retain(|c| c.key.pair != pair);
            }
        }
        let kept = parts.list.iter().map(|part| part.seen);
        self.free_seen.extend(kept.filter(|seen| *seen != NONE));
        if !parts.list.is_empty() {
            let kind = kind(parts.list.len());
            parts.list.clear();
            parts.clearances.clear();
            self.spare[kind].push(parts);
        }
        self.free.push(pair);
    }

    /// Forgets all pairs of a body.
    pub fn forget(&mut self, slot: usize) {
        while let Some(near) = self.links[slot].near.last() {
            self.separate(near.pair);
        }
    }

    /// Lists the pairs of parts of two bodies that come within reach for the first time, `ways` [m] being theirs.
    pub fn list_parts(&mut self, pair: u32, (count_a, count_b): (usize, usize), ways: f64) {
        let kind = kind(count_a * count_b);
        let parts = &mut self.list[pair as usize].parts;
        *parts = self.spare[kind].pop().unwrap_or_default();
        parts.list.reserve_exact(1 << kind);
        parts.clearances.reserve_exact(1 << kind);
        let unknown = ways + f64::MIN_POSITIVE - 1.0;
        parts.clearances.resize(count_a * count_b, unknown);
        for part_a in 0..count_a as u8 {
            parts.list.extend((0..count_b as u8).map(|part_b| PartPair {
                part_a,
                part_b,
                touching: false,
                rocks: false,
                seen: NONE,
                normal: DVec3::ZERO,
            }));
        }
    }

    /// Whether two bodies touch.
    pub fn any_touching(&self, a: usize, b: usize) -> bool {
        let (few, other) = if self.contacts(a).len() <= self.contacts(b).len() {
            (a, b)
        } else {
            (b, a)
        };
        let on = |c: &Contact| c.key.other(few) == other;
        self.contacts(few).iter().any(on)
    }

    /// Begins or ends a lasting contact.
    pub fn set_touching(&mut self, key: Key, on: bool) {
        let part = self.part_mut(key);
        if part.touching == on {
            return;
        }
        part.touching = on;
        if let Some(loads) = self.loads(key) {
            *loads = Default::default();
        }
        self.formed += 1;
        for slot in [key.a, key.b] {
            let contacts = &mut self.links[slot as usize].contacts;
            if on {
                let formed = self.formed;
                contacts.push(Contact { formed, key });
            } else {
                contacts.retain(|c| c.key != key);
            }
        }
    }

    /// What the points of a contact that was seen carry.
    pub fn loads(&mut self, key: Key) -> Option<&mut [Load; 4]> {
        let place = self.part(key).seen;
        let seen = self.seen.get_mut(place as usize)?;
        Some(&mut seen.loads)
    }

    /// The contact as it was seen last, if neither body has moved since: their ways [m] are still these.
    pub fn seen(&self, key: Key, ways: (f64, f64)) -> Option<Touch> {
        let seen = self.seen.get(self.part(key).seen as usize)?;
        (seen.ways == ways).then_some(seen.touch)
    }

    /// Keeps a contact as it is seen now.
    pub fn remember(&mut self, key: Key, ways: (f64, f64), touch: Touch) {
        let place = self.part(key).seen;
        if let Some(seen) = self.seen.get_mut(place as usize) {
            (seen.ways, seen.touch) = (ways, touch);
            return;
        }
        let loads = Default::default();
        let now = Seen { ways, touch, loads };
        let place = match self.free_seen.pop() {
            Some(place) => {
                self.seen[place as usize] = now;
                place
            }
            None => {
                self.seen.push(now);
                self.seen.len() as u32 - 1
            }
        };
        self.part_mut(key).seen = place;
    }

    fn place(&self, slot: usize, other: usize) -> Result<usize, usize> {
        let near = &self.links[slot].near;
        near.binary_search_by_key(&(other as u32), |n| n.other)
    }
}

/// The kind of list that has room for so many.
fn kind(count: usize) -> usize {
    count.next_power_of_two().trailing_zeros() as usize
}
