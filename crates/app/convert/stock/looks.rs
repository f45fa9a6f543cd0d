//! How surfaces look: linear colours, roughness, reflectance, patterns.

use anyhow::Result;
use renderer::{Material, Pattern, TextureId};

use super::Assets;
use crate::scenery::{Surface, oil};

/// Balls where faces have one colour: blue, green, orange, violet.
pub(super) const PLAIN_BALLS: [[f32; 3]; 4] = [
    [0.02, 0.06, 0.30],
    [0.01, 0.16, 0.06],
    [0.55, 0.14, 0.01],
    [0.16, 0.02, 0.26],
];

/// A surface without picture or pattern.
#[derive(Clone, Copy, Debug)]
pub(super) struct Coat {
    color: [f32; 3],
    roughness: f32,
    specular: f32,
}

impl Coat {
    pub fn material(self) -> Material {
        Material {
            roughness: self.roughness,
            specular: self.specular,
            ..Material::new(self.color)
        }
    }
}

/// Brushed metal: hardly any colour of its own, what is around it in its gloss.
pub(super) const METAL: Coat = Coat {
    color: [0.045, 0.045, 0.05],
    roughness: 0.36,
    specular: 0.38,
};

/// Dark board beside the pins.
pub(super) const KICKBACK: Coat = Coat {
    color: [0.06, 0.055, 0.06],
    roughness: 0.6,
    specular: 0.04,
};

/// Varnish: two coats of polyurethane over the wood.
const VARNISH: f32 = 0.045;

/// Mean colour of the lane's wood, where it has no pattern.
const MAPLE: [f32; 3] = [0.62, 0.38, 0.17];
/// Under the most oil, as practice shows it: bluer than it is, and smoother.
const OILED: [f32; 3] = [0.34, 0.36, 0.38];
const PINE: [f32; 3] = [0.46, 0.26, 0.11];

/// A surface of one colour.
pub(in crate::convert) fn plain(color: [f32; 3], roughness: f32) -> Material {
    Material {
        roughness,
        ..Material::new(color)
    }
}

/// A surface without any gloss.
fn matte(color: [f32; 3]) -> Material {
    Material {
        specular: 0.0,
        ..plain(color, 1.0)
    }
}

/// A ball with its marble.
pub(super) fn ball(texture: TextureId) -> Material {
    Material {
        texture: Some(texture),
        specular: 0.05,
        is_mirrored: true,
        ..plain([1.0; 3], 0.16)
    }
}

/// The looks of a scene, with the textures that they need and no others.
#[derive(Clone, Debug)]
pub(super) struct Looks {
    pub pin: Material,
    grain: Option<TextureId>,
    masking: Option<TextureId>,
    board: Option<TextureId>,
    has_materials: bool,
}

impl Looks {
    pub fn load(assets: &mut Assets<'_>, board: Option<TextureId>) -> Result<Self> {
        let has_materials = assets.shows.materials;
        let mut texture = |name: &str| has_materials.then(|| assets.texture(name)).transpose();
        let pin = Material {
            texture: texture("pin")?,
            is_mirrored: true,
            ..plain([0.86, 0.85, 0.82], 0.24)
        };
        Ok(Self {
            pin,
            grain: texture("grain")?,
            masking: texture("masking")?,
            board,
            has_materials,
        })
    }

    /// Planks of this colour, varnished as smoothly as `roughness` says.
    fn wood(&self, color: [f32; 3], roughness: f32) -> Material {
        if !self.has_materials {
            return plain(color.map(|part| 0.82 * part), roughness);
        }
        Material {
            pattern: Pattern::Planks,
            texture: self.grain,
            specular: VARNISH,
            ..plain(color, roughness)
        }
    }

    fn patterned(&self, pattern: Pattern, material: Material) -> Material {
        if self.has_materials {
            Material {
                pattern,
                ..material
            }
        } else {
            material
        }
    }

    /// The look of a part of the scenery.
    pub fn of(&self, surface: Surface) -> Material {
        let casts_shadows = matches!(
            surface,
            Surface::RackStand | Surface::Kickbacks | Surface::Seats
        );
        // No shadow is seen on what hangs, stands upright or has a light of its own.
        let takes_shadows = matches!(
            surface,
            Surface::Lane
                | Surface::Oil(_)
                | Surface::Approach
                | Surface::Markings
                | Surface::Gutters
                | Surface::Capping
                | Surface::Pit
                | Surface::Floor
                | Surface::RackStand
        );
        Material {
            casts_shadows,
            takes_shadows,
            ..self.color_of(surface)
        }
    }

    fn color_of(&self, surface: Surface) -> Material {
        let mirrored = |material| Material {
            is_mirrored: true,
            ..material
        };
        match surface {
            Surface::Lane => Material {
                mirror: 1.0,
                ..self.wood(MAPLE, 0.17)
            },
            Surface::Oil(level) => {
                let share = f32::from(level) / f32::from(oil::LEVELS);
                let tint = |part: usize| MAPLE[part] + share * (OILED[part] - MAPLE[part]);
                Material {
                    mirror: 1.0,
                    ..self.wood([tint(0), tint(1), tint(2)], 0.17 - 0.1 * share)
                }
            }
            Surface::Approach => Material {
                mirror: 1.0,
                ..self.wood(PINE, 0.26)
            },
            Surface::Markings => plain([0.035, 0.018, 0.012], 0.4),
            Surface::FoulLines => plain([0.02, 0.02, 0.02], 0.5),
            Surface::Gutters => plain([0.075, 0.08, 0.09], 0.38),
            // Dark wood between the gutters, which are of one grey with nothing but their shade to tell them apart.
            Surface::Capping => plain([0.11, 0.055, 0.03], 0.5),
            Surface::Pit => mirrored(matte([0.025, 0.025, 0.03])),
            Surface::Kickbacks => mirrored(KICKBACK.material()),
            Surface::Masking => mirrored(self.masking()),
            Surface::Floor => self.patterned(Pattern::Carpet, matte([0.035, 0.03, 0.075])),
            Surface::Walls => mirrored(matte([0.15, 0.22, 0.27])),
            Surface::Wainscot => Material {
                specular: 0.0,
                ..self.wood([0.20, 0.10, 0.05], 0.6)
            },
            Surface::Ceiling => {
                mirrored(self.patterned(Pattern::Panels, matte([0.30, 0.30, 0.31])))
            }
            Surface::Lamps => Material {
                emission: 2.4,
                ..mirrored(Material::unlit([1.0, 0.95, 0.86]))
            },
            Surface::RackStand => plain([0.06, 0.06, 0.07], 0.45),
            Surface::Seats => matte([0.42, 0.05, 0.06]),
            Surface::Metal => METAL.material(),
            Surface::Cases => mirrored(plain([0.02, 0.02, 0.022], 0.4)),
            Surface::IdleScreens => mirrored(self.idle_screen()),
            Surface::Neon => mirrored(Material::unlit([0.85, 0.10, 0.55])),
            Surface::Scoreboard => mirrored(Material {
                texture: self.board,
                ..Material::unlit([1.0; 3])
            }),
        }
    }

    /// Where nobody plays, the screen shows the picture of the panel over the pins, faintly.
    fn idle_screen(&self) -> Material {
        match self.masking {
            Some(texture) => Material {
                texture: Some(texture),
                ..Material::unlit([0.22, 0.24, 0.30])
            },
            None => Material::unlit([0.02, 0.05, 0.14]),
        }
    }

    /// The panel over the pins, lit from in front so that it glows a little.
    fn masking(&self) -> Material {
        match self.masking {
            Some(texture) => Material {
                texture: Some(texture),
                emission: 0.7,
                ..matte([0.9; 3])
            },
            None => plain([0.08, 0.11, 0.22], 0.7),
        }
    }
}
