//! What things are made of, and how they ring: the one table of the sound's constants.
//!
//! `[S]` stands for a published value or one computed from published values by the formula named, `[D]` for a design
//! choice. `tests/pitch.rs` computes every `[S]` frequency again, by code of its own.

/// What a body is made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Material {
    /// A ball: a solid sphere of polyester or urethane.
    Ball,
    /// A pin: maple with a plastic coat.
    Pin,
    /// Lane, deck and approach: maple boards on supports.
    Lane,
    /// A gutter: a thin half pipe of plastic.
    Gutter,
    /// A kickback: an upright wooden panel.
    Kickback,
    /// The cushion behind the pit: heavy cloth over rubber.
    Cushion,
    /// The pit's floor: a carpet belt.
    Pit,
    /// Walls, ceiling and floor of the room: plaster and concrete.
    Wall,
    /// The ball rack and the sweep: steel tube.
    Metal,
    /// The desk's board.
    Desk,
    /// A push button: a plastic cap.
    Button,
    /// A hand.
    Hand,
}

/// One way in which a body vibrates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mode {
    /// Frequency [Hz].
    pub frequency_hz: f64,
    /// Pressure at 1 m for each N s of an infinitely short blow [Pa m / (N s)].
    pub gain: f64,
}

const fn mode(frequency_hz: f64, gain: f64) -> Mode {
    Mode { frequency_hz, gain }
}

/// How a material takes a blow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Firmness {
    /// Young's modulus over `1 - nu^2` where it is touched [Pa].
    pub plane_modulus: f64,
    /// Radius of curvature where it is touched [m]; infinite for what is flat.
    pub radius: f64,
}

impl Material {
    /// All of them.
    pub const ALL: [Material; 12] = [
        Material::Ball,
        Material::Pin,
        Material::Lane,
        Material::Gutter,
        Material::Kickback,
        Material::Cushion,
        Material::Pit,
        Material::Wall,
        Material::Metal,
        Material::Desk,
        Material::Button,
        Material::Hand,
    ];

    /// The modes that are heard, lowest first.
    ///
    /// The gains are `[D]`, near `rho omega S U / (2 pi)` of a piston of the size that moves (L. L. Beranek, *Acoustics*,
    /// 1954, §4) with `U` the mode's speed for 1 N s, and less below the frequency at which a body is small against the wave.
    pub const fn modes(self) -> &'static [Mode] {
        const PIN: [Mode; 4] = [
            // [S] Bending of the free pin along its true profile as a Timoshenko beam, and its first stretch (5428 Hz);
            // sugar maple: E 12.6 GPa, G/E 0.111 (USDA, *Wood Handbook*, 2010, tables 5-1 and 5-3b).
            mode(1278.0, 2.6),
            mode(3744.0, 2.4),
            mode(5428.0, 1.5),
            mode(5712.0, 3.0),
        ];
        const BALL: [Mode; 3] = [
            // [S] Spheroidal modes 2, 1 and 3 of a solid sphere at Poisson's ratio 1/3 (H. Lamb, *On the Vibrations of an
            // Elastic Sphere*, Proc. London Math. Soc. 13, 1882), k a = 2.650, 3.596, 3.950; shear waves at 1000 m/s in
            // filled polyester [D], radius 0.1086 m.
            mode(3884.0, 6.0),
            mode(5270.0, 4.0),
            mode(5789.0, 3.0),
        ];
        const LANE: [Mode; 4] = [
            // [S] Boards 63.5 mm thick as a beam on supports 1.07 m apart [D]: f = (pi/2) n^2 h sqrt(E / 12 rho) / L^2 with
            // maple's E and 705 kg/m3.
            mode(106.0, 0.35),
            mode(425.0, 0.6),
            mode(957.0, 0.5),
            mode(1702.0, 0.3),
        ];
        const GUTTER: [Mode; 5] = [
            // [S] A ring's bending without stretch (Lord Rayleigh, *Theory of Sound*, §233), n = 3 to 7: radius 117.5 mm, 3.2 mm
            // of ABS (2.3 GPa, 1050 kg/m3, Poisson's ratio 0.37).
            mode(130.0, 1.2),
            mode(249.0, 1.5),
            mode(402.0, 1.2),
            mode(590.0, 0.9),
            mode(811.0, 0.6),
        ];
        const KICKBACK: [Mode; 5] = [
            // [S] A panel 0.61 by 1.5 m and 44.5 mm thick that is held at its edges (10 GPa, 650 kg/m3, Poisson's ratio
            // 0.3): f = (pi/2) sqrt(D / rho h) (m^2/a^2 + n^2/b^2).
            mode(259.0, 1.0),
            mode(371.0, 1.0),
            mode(557.0, 0.8),
            mode(817.0, 0.6),
            mode(927.0, 0.5),
        ];
        const CUSHION: [Mode; 3] = [mode(65.0, 1.2), mode(110.0, 0.9), mode(170.0, 0.4)];
        const PIT: [Mode; 2] = [mode(80.0, 0.6), mode(150.0, 0.3)];
        const WALL: [Mode; 2] = [mode(90.0, 0.5), mode(210.0, 0.3)];
        const METAL: [Mode; 4] = [
            mode(410.0, 1.0),
            mode(1130.0, 1.0),
            mode(2216.0, 0.8),
            mode(3663.0, 0.5),
        ];
        const DESK: [Mode; 3] = [mode(160.0, 1.2), mode(390.0, 1.0), mode(720.0, 0.7)];
        const BUTTON: [Mode; 3] = [mode(1200.0, 3.0), mode(2700.0, 3.0), mode(4100.0, 2.0)];
        match self {
            Material::Pin => &PIN,
            Material::Ball => &BALL,
            Material::Lane => &LANE,
            Material::Gutter => &GUTTER,
            Material::Kickback => &KICKBACK,
            Material::Cushion => &CUSHION,
            Material::Pit => &PIT,
            Material::Wall => &WALL,
            Material::Metal => &METAL,
            Material::Desk => &DESK,
            Material::Button => &BUTTON,
            Material::Hand => &[],
        }
    }

    /// Loss factor: the share of its energy that a vibration loses per radian, the reverse of its quality.
    ///
    /// Wood along the grain has 0.01, plates of wood with joints 0.03 to 0.1, plastics 0.03 to 0.05, rubber 0.1 to 1
    /// (L. Cremer, M. Heckl, *Structure-Borne Sound*, ch. 3); [D] within these.
    pub(crate) const fn loss_factor(self) -> f64 {
        match self {
            Material::Pin => 0.015,
            Material::Ball => 0.04,
            Material::Lane => 0.08,
            Material::Gutter => 0.03,
            Material::Kickback => 0.04,
            Material::Cushion => 0.3,
            Material::Pit => 0.4,
            Material::Wall => 0.15,
            Material::Metal => 0.006,
            Material::Desk => 0.04,
            Material::Button => 0.04,
            Material::Hand => 0.5,
        }
    }

    /// How it takes a blow.
    ///
    /// Maple across the grain 1.2 GPa (*Wood Handbook*, table 5-1: 0.07 to 0.13 of 12.6 GPa), cast polyester 3.5 GPa, ABS
    /// 2.3 GPa, rubber, cloth and flesh [D].
    pub(crate) const fn firmness(self) -> Firmness {
        const FLAT: f64 = f64::INFINITY;
        let (plane_modulus, radius) = match self {
            Material::Ball => (3.9e9, 0.1086),
            Material::Pin => (1.3e9, 0.0605),
            Material::Lane => (1.3e9, FLAT),
            Material::Gutter => (4.0e8, FLAT),
            Material::Kickback => (1.1e9, FLAT),
            Material::Cushion => (2.0e6, FLAT),
            Material::Pit => (1.0e7, FLAT),
            Material::Wall => (5.0e9, FLAT),
            Material::Metal => (2.0e10, 0.02),
            Material::Desk => (1.0e9, FLAT),
            Material::Button => (2.0e9, 0.03),
            Material::Hand => (2.0e5, 0.03),
        };
        Firmness {
            plane_modulus,
            radius,
        }
    }

    /// Radius of a sphere that pushes as much air aside [m]; zero for what is too large to move.
    ///
    /// A ball's own; for a pin that of its volume, 2.1 dm3.
    pub(crate) const fn air_radius(self) -> f64 {
        match self {
            Material::Ball => 0.1086,
            Material::Pin => 0.0796,
            _ => 0.0,
        }
    }
}
