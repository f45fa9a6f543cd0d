//! The same pairs of pieces in the same places, asked by each method whether they overlap.

use glam::{DQuat, DVec3};
use physics::query::{Limits, apart, separation};
use physics::rival::{Object, PlacedPiece, Rival, data_set};
use physics::{Pose, Shape};

use crate::support::Random;

/// Heaps, and muddles, that a scene goes through.
pub const ARRANGEMENTS: usize = 20;
/// Half the edge of the cube in which the objects of a muddle lie [m].
const SPREAD: f64 = 0.3;
/// Smallest depth of a muddle's pairs [m].
const DEEP: f64 = 0.005;
/// An object of a heap is up to this deep in the others, or up to this far from them [m].
const CLOSE: f64 = 0.001;
/// How far objects were from their places [m, rad] a picture earlier: 0.5 m/s and 3 rad/s at 90 pictures a second.
const STIR: (f64, f64) = (0.0056, 0.033);
const SEED: u64 = 0x5eed_0007;

/// A way to find out which pieces overlap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Contender {
    /// Points and edges against insides.
    Rival,
    /// The detection on parametric shapes from the line of centres: are they apart?
    Parametric,
    /// The same from the normal of the picture before.
    Warm,
    /// The detection on parametric shapes with position, normal and depth, of which the rival says nothing.
    Contact,
    /// The detection on the hulls of the polyhedra's vertices: are they apart?
    Cloud,
}

impl Contender {
    pub const ALL: [Contender; 5] = [
        Contender::Rival,
        Contender::Parametric,
        Contender::Warm,
        Contender::Contact,
        Contender::Cloud,
    ];

    pub fn name(self) -> &'static str {
        match self {
            Contender::Rival => "rival",
            Contender::Parametric => "parametric",
            Contender::Warm => "parametric, warm",
            Contender::Contact => "parametric, contact",
            Contender::Cloud => "vertex clouds",
        }
    }
}

/// Which pairs of pieces are asked about; the spheres have left all of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Workload {
    /// Those that are apart in a heap of objects that have been pushed together until they touch.
    Apart,
    /// Those that overlap in the heap, by up to a millimetre.
    Touching,
    /// Those that overlap by more than 5 mm where objects are put down anywhere. A simulation that answers contacts
    /// does not come to this.
    Deep,
}

impl Workload {
    pub const ALL: [Workload; 3] = [Workload::Apart, Workload::Touching, Workload::Deep];

    pub fn name(self) -> &'static str {
        match self {
            Workload::Apart => "apart",
            Workload::Touching => "touching",
            Workload::Deep => "deep",
        }
    }

    fn takes(self, test: &Test) -> bool {
        let overlapping = test.gap < 0.0;
        match self {
            Workload::Apart => test.heaped && !overlapping,
            Workload::Touching => test.heaped && overlapping,
            Workload::Deep => !test.heaped && test.gap < -DEEP,
        }
    }
}

/// A data set as formulas with polygons, and with the polyhedra's vertices for shapes.
pub struct DataSet {
    objects: Vec<Object>,
    clouds: Vec<Object>,
}

/// A pair of pieces.
struct Test<'a> {
    a: PlacedPiece<'a>,
    b: PlacedPiece<'a>,
    clouds: (&'a Shape, &'a Shape),
    /// Normal from a to b a picture earlier.
    start: DVec3,
    gap: f64,
    heaped: bool,
}

/// A data set in its arrangements.
pub struct Scene<'a> {
    tests: Vec<Test<'a>>,
}

impl DataSet {
    pub fn new(polygons: usize) -> DataSet {
        let objects = data_set(polygons).expect("enough polygons for 22 primitives");
        let mut clouds = objects.clone();
        for piece in clouds.iter_mut().flat_map(|object| &mut object.pieces) {
            piece.shape = Shape::cloud(piece.polyhedron.vertices())
                .expect("a polyhedron's vertices are finite");
        }
        DataSet { objects, clouds }
    }

    /// All pairs of pieces that the spheres leave; poses depend on neither the polygons nor the method.
    pub fn scene(&self) -> Scene<'_> {
        let mut random = Random(SEED);
        let mut tests = Vec::new();
        for arrangement in 0..2 * ARRANGEMENTS {
            let heaped = arrangement < ARRANGEMENTS;
            let poses = if heaped {
                heap(&self.objects, &mut random)
            } else {
                let place = |_| Pose::new(random.vector() * SPREAD, random.rotation());
                self.objects.iter().map(place).collect()
            };
            let near = near(&self.objects, &poses);
            for ((a, b), (c, d)) in near.into_iter().zip(self::near(&self.clouds, &poses)) {
                let clouds = (&c.piece.shape, &d.piece.shape);
                tests.push(Test::new((a, b), clouds, heaped, &mut random));
            }
        }
        Scene { tests }
    }
}

/// Objects that were pushed towards the first, each from somewhere, until they touched what was there.
fn heap(objects: &[Object], random: &mut Random) -> Vec<Pose> {
    let mut poses = Vec::new();
    for (k, object) in objects.iter().enumerate() {
        let (from, rotation) = (random.direction(), random.rotation());
        let wanted = CLOSE * random.next();
        let at = |distance: f64| Pose::new(from * distance, rotation);
        let others = || objects[..k].iter().zip(&poses);
        let gap = |pose: &Pose| {
            let gaps = others().map(|other| gap((object, pose), other));
            gaps.fold(f64::INFINITY, f64::min)
        };
        // A gap shrinks by no more than the way that is made, so that no step goes too far.
        let mut distance = if k == 0 { 0.0 } else { 2.0 };
        while distance > 0.0 {
            let left = gap(&at(distance)) - wanted;
            if left < 1e-9 {
                break;
            }
            distance -= left;
        }
        poses.push(at(distance));
    }
    poses
}

/// Gap between two objects: the smallest between their pieces [m].
fn gap(a: (&Object, &Pose), b: (&Object, &Pose)) -> f64 {
    let mut least = f64::INFINITY;
    for p in &a.0.pieces {
        for q in &b.0.pieces {
            let (at_p, at_q) = (*a.1 * p.pose, *b.1 * q.pose);
            let (p, q) = ((&p.shape, &at_p), (&q.shape, &at_q));
            least = least.min(separation(p, q, None, Limits::default()).gap);
        }
    }
    least
}

/// The pairs of pieces that the spheres leave.
fn near<'a>(objects: &'a [Object], poses: &[Pose]) -> Vec<(PlacedPiece<'a>, PlacedPiece<'a>)> {
    let placed = objects.iter().zip(poses);
    let placed: Vec<_> = placed.map(|(object, pose)| object.place(pose)).collect();
    let mut near = Vec::new();
    for (k, a) in placed.iter().enumerate() {
        for b in &placed[k + 1..] {
            a.overlaps(b, |p, q| {
                near.push((p, q));
                false
            });
        }
    }
    near
}

impl<'a> Test<'a> {
    fn new(
        (a, b): (PlacedPiece<'a>, PlacedPiece<'a>),
        clouds: (&'a Shape, &'a Shape),
        heaped: bool,
        random: &mut Random,
    ) -> Test<'a> {
        let mut before = |pose: &Pose| {
            let turn = DQuat::from_scaled_axis(random.direction() * STIR.1);
            let position = pose.position + random.direction() * STIR.0;
            Pose::new(position, turn * pose.rotation)
        };
        let exact = |pose_a: &Pose, pose_b: &Pose| {
            let (a, b) = (&a.piece.shape, &b.piece.shape);
            separation((a, pose_a), (b, pose_b), None, Limits::default())
        };
        Test {
            start: exact(&before(&a.pose), &before(&b.pose)).normal,
            gap: exact(&a.pose, &b.pose).gap,
            heaped,
            a,
            b,
            clouds,
        }
    }

    /// Whether the pieces overlap, by one method.
    fn ask(&self, contender: Contender, rival: &mut Rival) -> bool {
        let (a, b) = (&self.a, &self.b);
        let limits = Limits::default();
        let parametric = ((&a.piece.shape, &a.pose), (&b.piece.shape, &b.pose));
        match contender {
            Contender::Rival => rival.overlap(
                (&a.piece.polyhedron, &a.pose),
                (&b.piece.polyhedron, &b.pose),
            ),
            Contender::Parametric => apart(parametric.0, parametric.1, None, limits).is_none(),
            Contender::Warm => {
                apart(parametric.0, parametric.1, Some(self.start), limits).is_none()
            }
            Contender::Contact => {
                let found = separation(parametric.0, parametric.1, None, limits);
                std::hint::black_box(found.contact()).depth > 0.0
            }
            Contender::Cloud => {
                let (c, d) = self.clouds;
                apart((c, &a.pose), (d, &b.pose), None, limits).is_none()
            }
        }
    }
}

impl Scene<'_> {
    /// How many pairs of pieces a workload has.
    pub fn count(&self, workload: Workload) -> usize {
        self.chosen(workload).count()
    }

    /// A pass of one method through a workload, which returns how many pairs overlap.
    pub fn runner(&self, contender: Contender, workload: Workload) -> impl FnMut() -> usize {
        let mut rival = Rival::default();
        let tests: Vec<&Test> = self.chosen(workload).collect();
        move || {
            let overlapping = |test: &&&Test| test.ask(contender, &mut rival);
            tests.iter().filter(overlapping).count()
        }
    }

    fn chosen(&self, workload: Workload) -> impl Iterator<Item = &Test<'_>> {
        self.tests.iter().filter(move |test| workload.takes(test))
    }
}
