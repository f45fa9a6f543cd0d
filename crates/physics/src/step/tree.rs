//! A tree of boxes that tells which of many are near one: the broad phase.
//!
//! Each leaf is the box that one body may not leave before it is put in anew. Inner nodes hold the box around their
//! two children. A leaf goes where it adds least surface to the boxes above it, and on the way back up every node
//! swaps a child with a grandchild where that makes a box smaller; so the depth grows with the logarithm of the
//! number of leaves in every order of insertion that an alley knows (lanes side by side, racks, equal boxes).

use glam::DVec3;

/// No node.
const NONE: u32 = u32::MAX;

/// Box with its faces along the axes, from its low to its high corner [m], world frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bounds {
    pub low: DVec3,
    pub high: DVec3,
}

impl Bounds {
    /// The box around a ball.
    pub fn around(centre: DVec3, radius: f64) -> Bounds {
        let reach = DVec3::splat(radius);
        Bounds {
            low: centre - reach,
            high: centre + reach,
        }
    }

    /// Whether the two share a point.
    pub fn meets(&self, other: &Bounds) -> bool {
        self.low.cmple(other.high).all() && other.low.cmple(self.high).all()
    }

    /// Whether it is a box at all, and one of finite size.
    pub fn is_finite(&self) -> bool {
        self.low.is_finite() && self.high.is_finite()
    }

    /// The box around both.
    pub fn with(&self, other: &Bounds) -> Bounds {
        Bounds {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }

    /// Half of its surface [m2].
    fn surface(&self) -> f64 {
        let d = self.high - self.low;
        d.x * d.y + d.y * d.z + d.z * d.x
    }
}

#[derive(Clone, Copy, Debug)]
struct Node {
    bounds: Bounds,
    parent: u32,
    /// Both children of an inner node; `NONE` twice in a leaf.
    children: [u32; 2],
    /// Whose leaf it is.
    body: u32,
    /// Longest way down to a leaf; decides between children that are equally good.
    height: u32,
}

/// Boxes of bodies, found by where they are.
#[derive(Clone, Debug)]
pub(crate) struct Tree {
    nodes: Vec<Node>,
    free: Vec<u32>,
    root: u32,
    /// Leaf of each body.
    leaves: Vec<u32>,
}

impl Default for Tree {
    fn default() -> Tree {
        Tree {
            nodes: Vec::new(),
            free: Vec::new(),
            root: NONE,
            leaves: Vec::new(),
        }
    }
}

impl Tree {
    /// Puts a body's box in, or in the place of its old one. A box that is not finite only takes the old one out.
    pub fn put(&mut self, body: u32, bounds: Bounds) {
        self.remove(body);
        if !bounds.is_finite() {
            return;
        }
        if self.leaves.len() <= body as usize {
            self.leaves.resize(body as usize + 1, NONE);
        }
        let leaf = self.node(bounds, [NONE, NONE], body);
        self.leaves[body as usize] = leaf;
        if self.root == NONE {
            self.root = leaf;
            return;
        }
        let sibling = self.best_sibling(&bounds);
        let parent = self.nodes[sibling as usize].parent;
        let both = bounds.with(&self.nodes[sibling as usize].bounds);
        let joint = self.node(both, [sibling, leaf], NONE);
        self.nodes[joint as usize].parent = parent;
        self.replace_child(parent, sibling, joint);
        self.nodes[sibling as usize].parent = joint;
        self.nodes[leaf as usize].parent = joint;
        self.refit(joint);
    }

    /// Takes a body's box out, if it has one.
    pub fn remove(&mut self, body: u32) {
        let Some(leaf) = self.leaves.get_mut(body as usize) else {
            return;
        };
        let leaf = std::mem::replace(leaf, NONE);
        if leaf == NONE {
            return;
        }
        self.free.push(leaf);
        let joint = self.nodes[leaf as usize].parent;
        if joint == NONE {
            self.root = NONE;
            return;
        }
        let Node {
            children, parent, ..
        } = self.nodes[joint as usize];
        let sibling = children[usize::from(children[0] == leaf)];
        self.replace_child(parent, joint, sibling);
        self.nodes[sibling as usize].parent = parent;
        self.free.push(joint);
        self.refit(parent);
    }

    /// Appends all bodies whose boxes meet `bounds`, in no order that matters. `stack` is room to work in.
    pub fn find(&self, bounds: &Bounds, stack: &mut Vec<u32>, found: &mut Vec<u32>) {
        stack.clear();
        if self.root != NONE {
            stack.push(self.root);
        }
        while let Some(index) = stack.pop() {
            let node = &self.nodes[index as usize];
            if !node.bounds.meets(bounds) {
                continue;
            }
            if node.body != NONE {
                found.push(node.body);
            } else {
                stack.extend(node.children);
            }
        }
    }

    fn node(&mut self, bounds: Bounds, children: [u32; 2], body: u32) -> u32 {
        let node = Node {
            bounds,
            parent: NONE,
            children,
            body,
            height: 0,
        };
        match self.free.pop() {
            Some(index) => {
                self.nodes[index as usize] = node;
                index
            }
            None => {
                self.nodes.push(node);
                self.nodes.len() as u32 - 1
            }
        }
    }

    /// The node beside which a new box adds least surface: down from the root, as long as a child promises less.
    fn best_sibling(&self, bounds: &Bounds) -> u32 {
        let mut index = self.root;
        loop {
            let node = &self.nodes[index as usize];
            if node.body != NONE {
                return index;
            }
            let grown = node.bounds.with(bounds).surface();
            // What a leaf further down costs at least: every box above it grows too.
            let inherited = grown - node.bounds.surface();
            let cost = |child: u32| {
                let child = &self.nodes[child as usize];
                let joint = child.bounds.with(bounds).surface();
                let own = if child.body == NONE {
                    child.bounds.surface()
                } else {
                    0.0
                };
                (joint - own + inherited, child.height)
            };
            let [left, right] = node.children;
            let (cost_left, cost_right) = (cost(left), cost(right));
            let better = if cost_left <= cost_right { left } else { right };
            if grown < cost_left.0.min(cost_right.0) {
                return index;
            }
            index = better;
        }
    }

    fn replace_child(&mut self, parent: u32, old: u32, new: u32) {
        if parent == NONE {
            self.root = new;
            return;
        }
        let children = &mut self.nodes[parent as usize].children;
        children[usize::from(children[1] == old)] = new;
    }

    /// Makes the boxes from `index` up to the root fit again, and smaller where a swap does it.
    fn refit(&mut self, mut index: u32) {
        while index != NONE {
            self.swap_for_less(index);
            self.fit(index);
            index = self.nodes[index as usize].parent;
        }
    }

    fn fit(&mut self, index: u32) {
        let [left, right] = self.nodes[index as usize].children;
        let (left, right) = (&self.nodes[left as usize], &self.nodes[right as usize]);
        let bounds = left.bounds.with(&right.bounds);
        let height = 1 + left.height.max(right.height);
        let node = &mut self.nodes[index as usize];
        (node.bounds, node.height) = (bounds, height);
    }

    /// Swaps a child of the node with a grandchild on the other side, if that makes the other child's box smaller.
    fn swap_for_less(&mut self, index: u32) {
        let children = self.nodes[index as usize].children;
        let mut best: Option<(f64, usize, usize)> = None;
        for side in 0..2 {
            let (child, other) = (children[side], children[1 - side]);
            let other = &self.nodes[other as usize];
            if other.body != NONE {
                continue;
            }
            let moved = &self.nodes[child as usize];
            for k in 0..2 {
                // The grandchild k comes up, the child goes down beside the one that stays.
                let stays = &self.nodes[other.children[1 - k] as usize];
                let gain = other.bounds.surface() - stays.bounds.with(&moved.bounds).surface();
                let up = &self.nodes[other.children[k] as usize];
                // Equal boxes gain nothing by size; there the deeper side gives.
                let level = gain == 0.0 && up.height > moved.height;
                if (gain > 0.0 || level) && best.is_none_or(|b| gain > b.0) {
                    best = Some((gain, side, k));
                }
            }
        }
        let Some((_, side, k)) = best else { return };
        let (child, other) = (children[side], children[1 - side]);
        let up = self.nodes[other as usize].children[k];
        self.nodes[other as usize].children[k] = child;
        self.nodes[child as usize].parent = other;
        self.nodes[index as usize].children[side] = up;
        self.nodes[up as usize].parent = index;
        self.fit(other);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    /// Three numbers in [0, 1).
    fn corner(random: &mut Random) -> DVec3 {
        DVec3::new(random.unit(), random.unit(), random.unit())
    }

    fn depth(tree: &Tree) -> u32 {
        tree.nodes[tree.root as usize].height
    }

    fn check(tree: &Tree) {
        for (index, node) in tree.nodes.iter().enumerate() {
            if tree.free.contains(&(index as u32)) || node.body != NONE {
                continue;
            }
            for child in node.children {
                let child = &tree.nodes[child as usize];
                assert_eq!(child.parent, index as u32);
                assert_eq!(node.bounds.with(&child.bounds), node.bounds);
            }
        }
    }

    #[test]
    fn find_agrees_with_looking_at_every_box() {
        let seed = 20_261_122;
        println!("seed {seed}");
        let mut random = Random(seed);
        let mut tree = Tree::default();
        let mut boxes: Vec<Option<Bounds>> = vec![None; 300];
        let (mut stack, mut found) = (Vec::new(), Vec::new());
        for round in 0..20_000 {
            let body = (random.unit() * 300.0) as usize;
            if random.unit() < 0.2 {
                tree.remove(body as u32);
                boxes[body] = None;
            } else {
                // Long, flat and tiny ones too.
                let size = corner(&mut random) * corner(&mut random) * corner(&mut random) * 4.0;
                let low = corner(&mut random) * 10.0;
                let bounds = Bounds {
                    low,
                    high: low + size,
                };
                tree.put(body as u32, bounds);
                boxes[body] = Some(bounds);
            }
            if round == 0 || round == 19_999 {
                check(&tree);
            }
            let probe = Bounds::around(corner(&mut random) * 10.0, random.unit());
            found.clear();
            tree.find(&probe, &mut stack, &mut found);
            found.sort_unstable();
            let meets = |i: &u32| boxes[*i as usize].is_some_and(|b| b.meets(&probe));
            let expected: Vec<u32> = (0..300).filter(meets).collect();
            assert_eq!(found, expected);
        }
    }

    #[test]
    fn depth_stays_logarithmic_for_rows_racks_and_equal_boxes() {
        let row = |i: u32| DVec3::X * 1.9 * f64::from(i);
        let rack = |i: u32| row(i / 12) + DVec3::new(0.3, 0.0, 0.3) * f64::from(i % 12);
        let equal = |_: u32| DVec3::ZERO;
        for (name, place) in [
            ("row", &row as &dyn Fn(u32) -> DVec3),
            ("rack", &rack),
            ("equal", &equal),
        ] {
            let mut tree = Tree::default();
            for i in 0..4096 {
                tree.put(i, Bounds::around(place(i), 0.25));
            }
            assert!(depth(&tree) <= 30, "{name}: {}", depth(&tree));
        }
    }

    #[test]
    fn put_ignores_boxes_that_are_not_finite() {
        let mut tree = Tree::default();
        tree.put(0, Bounds::around(DVec3::ZERO, 1.0));
        tree.put(1, Bounds::around(DVec3::NAN, 1.0));
        tree.put(0, Bounds::around(DVec3::ZERO, f64::INFINITY));
        assert_eq!((tree.root, &tree.leaves[..]), (NONE, &[NONE][..]));
    }
}
