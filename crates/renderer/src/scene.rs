//! What is drawn: plain data, put together anew for every frame.

use glam::{Mat4, Vec3};

/// A mesh held by a [`crate::Renderer`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct MeshId(pub(crate) u32);

/// A texture held by a [`crate::Renderer`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct TextureId(pub(crate) u32);

/// What a surface's colour is multiplied by.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Pattern {
    /// The texture, as it is.
    #[default]
    Texture,
    /// Planks along v [m], one to a unit of u; the texture holds their grain.
    Planks,
    /// A pile with coloured rings, one to a unit of u and v.
    Carpet,
    /// Panels with a joint round each, one to a unit of u and v.
    Panels,
}

/// How a surface looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Share of light sent back diffusely, linear red, green, blue, 0 to 1; multiplies the texture.
    pub base_color: [f32; 3],
    /// 0 mirror-like to 1 matte; the square is the width of the GGX lobe.
    pub roughness: f32,
    /// Share reflected mirror-like at normal incidence; 0.04 for varnish and plastics, 0 for none at all.
    pub specular: f32,
    /// Light sent out by itself, as a multiple of base colour times texture; 1 for a lit screen.
    pub emission: f32,
    /// Picture that multiplies the base colour; its alpha is not used.
    pub texture: Option<TextureId>,
    /// How many times texture or pattern repeat per unit of the mesh's u and v.
    pub texture_repeat: [f32; 2],
    /// What the base colour is multiplied by.
    pub pattern: Pattern,
    /// Share of the gloss that shows the image in the floor at y = 0, 0 to 1; above 0 for that floor alone.
    pub mirror: f32,
    /// It is seen in the glossy floor.
    pub is_mirrored: bool,
    /// It throws shadows.
    pub casts_shadows: bool,
    /// Shadows fall on it.
    pub takes_shadows: bool,
}

impl Material {
    /// A surface of one linear colour with the sheen of painted wood.
    pub fn new(base_color: [f32; 3]) -> Self {
        Self {
            base_color,
            roughness: 0.5,
            specular: 0.04,
            emission: 0.0,
            texture: None,
            texture_repeat: [1.0, 1.0],
            pattern: Pattern::Texture,
            mirror: 0.0,
            is_mirrored: false,
            casts_shadows: true,
            takes_shadows: true,
        }
    }

    /// A surface that only shows its own light: base colour times texture, whatever the lights.
    pub fn unlit(base_color: [f32; 3]) -> Self {
        Self {
            specular: 0.0,
            emission: 1.0,
            ..Self::new(base_color)
        }
    }
}

/// One mesh at one place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instance {
    /// What is drawn.
    pub mesh: MeshId,
    /// How it looks.
    pub material: Material,
    /// Where it is; affine, and not a mirror image.
    pub world_from_mesh: Mat4,
}

/// Where the light that casts shadows comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightSource {
    /// Parallel rays along `direction` (world frame, any length). Its colour is the same everywhere.
    Directional {
        /// The way the light travels.
        direction: Vec3,
        /// Least corner of the box in which shadows are cast and received [m].
        shadow_min: Vec3,
        /// Greatest corner of that box [m].
        shadow_max: Vec3,
    },
    /// A cone from a point; its colour is the value at 1 m and falls with the square of the distance.
    Spot {
        /// Tip of the cone [m].
        position: Vec3,
        /// Axis of the cone (any length).
        direction: Vec3,
        /// Half angle at which it begins to fade [rad].
        inner: f32,
        /// Half angle at which it ends [rad], below 1.4.
        outer: f32,
        /// How far it casts shadows [m].
        range_m: f32,
    },
}

/// The one light that casts shadows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Where it comes from.
    pub source: LightSource,
    /// Linear colour: what a white matte surface facing it shows.
    pub color: [f32; 3],
    /// Half width of the shadows' soft edge [m], at 1 m for a spot light.
    pub softness_m: f32,
}

/// A small light without a shadow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lamp {
    /// Where it is [m].
    pub position: Vec3,
    /// Linear colour: what a white matte surface facing it at 1 m shows.
    pub color: [f32; 3],
    /// Distance at which it has faded to nothing [m].
    pub range_m: f32,
}

/// Most lamps in one scene; each costs time on every pixel.
pub const MAX_LAMPS: usize = 8;

/// A ball that hides the sky from what is near it; any thing is a few of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Occluder {
    /// Its middle [m].
    pub position: Vec3,
    /// Its radius [m].
    pub radius_m: f32,
}

/// Most occluders in one scene; each costs time on every pixel.
pub const MAX_OCCLUDERS: usize = 32;

/// The inside of a building: where its walls meet, less light arrives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Enclosure {
    /// Least corner [m].
    pub min: Vec3,
    /// Greatest corner [m].
    pub max: Vec3,
    /// Distance over which the dimness fades [m].
    pub reach_m: f32,
}

/// A dark edge over the picture, round what lies straight ahead.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vignette {
    /// Angle from straight ahead up to which nothing is darkened [rad].
    pub clear: f32,
    /// How dark it is beyond, from 0 to 1.
    pub strength: f32,
}

/// Everything that is drawn in one frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// The things in it, in any order.
    pub instances: Vec<Instance>,
    /// The light that casts shadows, if there is one.
    pub light: Option<Light>,
    /// Lights without shadows, at most [`MAX_LAMPS`].
    pub lamps: Vec<Lamp>,
    /// Linear colour of the light from straight above.
    pub sky: [f32; 3],
    /// Linear colour of the light from straight below: what the floor sends back.
    pub ground: [f32; 3],
    /// Linear colour where nothing is.
    pub background: [f32; 3],
    /// What hides the sky, at most [`MAX_OCCLUDERS`].
    pub occluders: Vec<Occluder>,
    /// The building's inside, if its corners are to be dim.
    pub enclosure: Option<Enclosure>,
    /// The dark edge of the picture, if it is to have one.
    pub vignette: Option<Vignette>,
}

impl Default for Scene {
    /// An empty scene under a dim, slightly warm indoor light.
    fn default() -> Self {
        Self {
            instances: Vec::new(),
            light: None,
            lamps: Vec::new(),
            sky: [0.34, 0.32, 0.29],
            ground: [0.20, 0.16, 0.12],
            background: [0.02, 0.018, 0.016],
            occluders: Vec::new(),
            enclosure: None,
            vignette: None,
        }
    }
}
