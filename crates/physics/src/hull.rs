//! Convex hulls of points, grown corner by corner: of a vertex cloud once, and of differences in every overlap.

use glam::DVec3;

/// What is gained below this is rounding, in units of the size.
const ROUNDING: f64 = 1e-14;

/// A triangle of a growing hull.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Facet {
    pub corners: [usize; 3],
    /// Outward unit normal; zero where the triangle has no area.
    pub normal: DVec3,
    /// Height of its plane over the origin [m].
    pub offset: f64,
}

/// A closed surface of triangles that grows by one corner at a time.
#[derive(Clone, Debug)]
pub(crate) struct Surface {
    pub points: Vec<DVec3>,
    pub facets: Vec<Facet>,
    /// Sides around what a new corner sees; kept for its memory.
    rim: Vec<(usize, usize)>,
}

impl Surface {
    /// The surface of four points that span a volume, with room for `more` corners.
    pub fn new(points: [DVec3; 4], more: usize) -> Surface {
        let mut surface = Surface {
            points: Vec::with_capacity(4 + more),
            facets: Vec::with_capacity(4 + 2 * more),
            rim: Vec::with_capacity(16),
        };
        surface.points.extend(points);
        let [p, q, r, t] = points;
        let sides = if (q - p).cross(r - p).dot(t - p) > 0.0 {
            [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]
        } else {
            [[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]]
        };
        for corners in sides {
            surface.put(corners);
        }
        surface
    }

    fn put(&mut self, corners: [usize; 3]) {
        let [p, q, r] = corners.map(|i| self.points[i]);
        let outward = (q - p).cross(r - p);
        let length = outward.length();
        let normal = if length > 0.0 {
            outward / length
        } else {
            DVec3::ZERO
        };
        self.facets.push(Facet {
            corners,
            normal,
            offset: normal.dot(p),
        });
    }

    /// Puts `point` in place of the facets that it is over by more than `slack` [m]; without any, nothing changes.
    pub fn add(&mut self, point: DVec3, slack: f64) {
        let mut i = 0;
        while i < self.facets.len() {
            let facet = self.facets[i];
            if facet.normal.dot(point) - facet.offset <= slack {
                i += 1;
                continue;
            }
            let [p, q, r] = facet.corners;
            for side in [(p, q), (q, r), (r, p)] {
                match self.rim.iter().position(|e| *e == (side.1, side.0)) {
                    Some(twin) => {
                        self.rim.swap_remove(twin);
                    }
                    None => self.rim.push(side),
                }
            }
            self.facets.swap_remove(i);
        }
        if self.rim.is_empty() {
            return;
        }
        let top = self.points.len();
        self.points.push(point);
        for i in 0..self.rim.len() {
            let (p, q) = self.rim[i];
            self.put([p, q, top]);
        }
        self.rim.clear();
    }

    /// How far `point` lies over the highest plane [m]; not positive inside.
    fn beyond(&self, point: DVec3) -> f64 {
        let over = |facet: &Facet| match facet.normal {
            DVec3::ZERO => f64::NEG_INFINITY,
            normal => normal.dot(point) - facet.offset,
        };
        self.facets
            .iter()
            .map(over)
            .fold(f64::NEG_INFINITY, f64::max)
    }
}

/// All points with `normal . p <= offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Plane {
    /// Outward unit normal.
    pub normal: DVec3,
    /// Height over the origin [m].
    pub offset: f64,
}

/// The hull of a vertex cloud.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Hull {
    /// Its corners; of points in one plane, all that differ [m].
    pub corners: Vec<DVec3>,
    /// Its faces, each once; none if all points lie in a plane.
    pub planes: Vec<Plane>,
    /// Mean of the corners [m].
    pub centre: DVec3,
    /// Where the search for a farthest corner begins; none for a few corners, of which all are tried.
    compass: Option<Compass>,
}

impl Hull {
    /// The hull of at least one point, all of them finite.
    pub fn new(points: &[DVec3]) -> Hull {
        let (corners, planes, compass) = match wrap(points) {
            Some(solid) => solid,
            None => (differing(points), Vec::new(), None),
        };
        let centre = corners.iter().copied().sum::<DVec3>() / corners.len() as f64;
        Hull {
            corners,
            planes,
            centre,
            compass,
        }
    }

    /// Number of the corner farthest along `n`.
    #[inline]
    pub fn farthest(&self, n: DVec3) -> usize {
        match &self.compass {
            Some(compass) => compass.farthest(&self.corners, n),
            None => farthest(&self.corners, n),
        }
    }

    /// Radius of the largest ball about `point` inside [m]; `None` outside and in a hull without volume.
    pub fn inner_radius(&self, point: DVec3) -> Option<f64> {
        let depth = |plane: &Plane| plane.offset - plane.normal.dot(point);
        let radius = self.planes.iter().map(depth).fold(f64::INFINITY, f64::min);
        (radius >= 0.0 && radius.is_finite()).then_some(radius)
    }
}

fn differing(points: &[DVec3]) -> Vec<DVec3> {
    let mut different = points.to_vec();
    different.sort_by(|p, q| {
        let by = |i: usize| p[i].total_cmp(&q[i]);
        by(0).then(by(1)).then(by(2))
    });
    different.dedup();
    different
}

/// Number of the point farthest along n; the first of several.
fn farthest(points: &[DVec3], n: DVec3) -> usize {
    let (mut best, mut height) = (0, f64::NEG_INFINITY);
    for (i, p) in points.iter().enumerate() {
        let h = n.dot(*p);
        (best, height) = if h > height { (i, h) } else { (best, height) };
    }
    best
}

/// Finds farthest corners by climbing along edges, from a corner that is farthest in a direction close by.
#[derive(Clone, Debug, PartialEq)]
struct Compass {
    /// Neighbours of corner i are `links[ends[i]..ends[i + 1]]`.
    ends: Vec<u32>,
    links: Vec<u32>,
    /// Cells on each side of a cube's faces, and a corner for each cell.
    cells: usize,
    seeds: Vec<u32>,
}

impl Compass {
    /// A compass over the first corners, joined by `edges`, each in both directions.
    fn new(corners: &[DVec3], edges: &[(usize, usize)]) -> Compass {
        let mut edges = edges.to_vec();
        edges.sort_unstable();
        let ends = (0..=corners.len())
            .map(|i| edges.partition_point(|e| e.0 < i) as u32)
            .collect();
        let cells = ((corners.len() as f64).sqrt() * 0.5).ceil().min(16.0) as usize;
        let mut seeds = Vec::with_capacity(6 * cells * cells);
        for cell in 0..6 * cells * cells {
            let (face, row, column) = (cell / cells / cells, cell / cells % cells, cell % cells);
            let at = |i: usize| 2.0 * (i as f64 + 0.5) / cells as f64 - 1.0;
            let mut n = DVec3::ZERO;
            n[face / 2] = if face % 2 == 0 { 1.0 } else { -1.0 };
            n[(face / 2 + 1) % 3] = at(row);
            n[(face / 2 + 2) % 3] = at(column);
            seeds.push(farthest(corners, n) as u32);
        }
        let links = edges.iter().map(|e| e.1 as u32).collect();
        Compass {
            ends,
            links,
            cells,
            seeds,
        }
    }

    fn cell(&self, n: DVec3) -> usize {
        let size = n.abs();
        let (axis, along, row, column) = if size.x >= size.y && size.x >= size.z {
            (0, n.x, n.y, n.z)
        } else if size.y >= size.z {
            (1, n.y, n.z, n.x)
        } else {
            (2, n.z, n.x, n.y)
        };
        let scale = 0.5 * self.cells as f64;
        let inverse = scale / along.abs();
        let index = |x: f64| ((x * inverse + scale) as usize).min(self.cells - 1);
        let face = 2 * axis + usize::from(along < 0.0);
        (face * self.cells + index(row)) * self.cells + index(column)
    }

    fn farthest(&self, corners: &[DVec3], n: DVec3) -> usize {
        let mut best = self.seeds[self.cell(n)] as usize;
        let mut height = n.dot(corners[best]);
        loop {
            let (from, to) = (self.ends[best] as usize, self.ends[best + 1] as usize);
            let here = best;
            for link in &self.links[from..to] {
                let h = n.dot(corners[*link as usize]);
                if h > height {
                    (best, height) = (*link as usize, h);
                }
            }
            if best == here {
                break;
            }
        }
        // Corners without edges: what a sliver's plane left out by rounding.
        for (i, corner) in corners.iter().enumerate().skip(self.ends.len() - 1) {
            let h = n.dot(*corner);
            if h > height {
                (best, height) = (i, h);
            }
        }
        best
    }
}

/// Fewer corners than these are all tried.
const MANY: usize = 24;

/// Corners, faces and the compass; `None` if the points span no volume.
fn wrap(points: &[DVec3]) -> Option<(Vec<DVec3>, Vec<Plane>, Option<Compass>)> {
    let first = widest(points)?;
    let size = points
        .iter()
        .map(|p| p.distance(first[0]))
        .fold(0.0, f64::max);
    let mut surface = Surface::new(first, points.len());
    for p in points {
        surface.add(*p, 1e-12 * size);
    }
    let mut number = vec![usize::MAX; surface.points.len()];
    let mut corners: Vec<DVec3> = Vec::new();
    let mut edges = Vec::new();
    for facet in &surface.facets {
        for i in facet.corners {
            if number[i] == usize::MAX {
                number[i] = corners.len();
                corners.push(surface.points[i]);
            }
        }
        let [p, q, r] = facet.corners.map(|i| number[i]);
        edges.extend([(p, q), (q, r), (r, p)]);
    }
    let compass = (corners.len() >= MANY).then(|| Compass::new(&corners, &edges));
    // What a sliver's plane has left out by rounding counts too: the support point stays exact.
    let known = corners.len();
    for p in points {
        if surface.beyond(*p) > ROUNDING * size && !corners[..known].contains(p) {
            corners.push(*p);
        }
    }
    let planes = faces(&surface, &corners);
    Some((corners, planes, compass))
}

/// The planes of the surface, each once, with all corners behind them.
fn faces(surface: &Surface, corners: &[DVec3]) -> Vec<Plane> {
    let mut planes: Vec<Plane> = Vec::new();
    for facet in &surface.facets {
        let normal = facet.normal;
        let same = |plane: &Plane| plane.normal.dot(normal) > 1.0 - 1e-14;
        if normal == DVec3::ZERO || planes.iter().any(same) {
            continue;
        }
        let height = |p: &DVec3| normal.dot(*p);
        let offset = corners.iter().map(height).fold(f64::NEG_INFINITY, f64::max);
        planes.push(Plane { normal, offset });
    }
    planes
}

/// Four of the points, each as far as possible from what the ones before it span.
fn widest(points: &[DVec3]) -> Option<[DVec3; 4]> {
    let farthest = |spread: &dyn Fn(DVec3) -> f64| {
        let mut best = (0.0, points[0]);
        for p in points {
            let width = spread(*p);
            if width > best.0 {
                best = (width, *p);
            }
        }
        best
    };
    let p = farthest(&|x| x.distance(points[0])).1;
    let (size, q) = farthest(&|x| x.distance(p));
    let along = (q - p).try_normalize()?;
    let (width, r) = farthest(&|x| (x - p).cross(along).length());
    let normal = along.cross(r - p).try_normalize()?;
    let (height, t) = farthest(&|x| normal.dot(x - p).abs());
    (width > 1e-10 * size && height > 1e-10 * size).then_some([p, q, r, t])
}

#[cfg(test)]
mod tests;
