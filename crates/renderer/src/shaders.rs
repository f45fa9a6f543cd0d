//! Every shader of the program, put together from the files in `shaders/` by joining texts.

/// The text of one file of `shaders/`.
macro_rules! file {
    ($file:literal) => {
        include_str!(concat!("../../../shaders/", $file, ".wgsl"))
    };
}

/// Depth as the shadowing light sees it.
pub(crate) const SHADOW: &str = concat!(
    include_str!("../../../shaders/common.wgsl"),
    include_str!("../../../shaders/shadow.wgsl")
);
/// An image at half its size.
pub(crate) const SHRINK: &str = file!("shrink");
/// Parts of a picture that no eye sees.
pub(crate) const HIDDEN: &str = file!("hidden");
/// Images into rectangles of the window.
pub(crate) const PRESENT: &str = file!("present");
/// A dark edge over a picture.
pub(crate) const VIGNETTE: &str = file!("vignette");

/// What the eyes' pass looks up beside the surfaces themselves; what is off is neither bound nor read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Lookups {
    pub shadows: bool,
    pub mirror: bool,
    pub occlusion: bool,
}

/// Lit surfaces, with these lookups.
pub(crate) fn lit(lookups: Lookups) -> String {
    let pick = |is_on, on, off| if is_on { on } else { off };
    [
        file!("common"),
        file!("lighting"),
        file!("look"),
        file!("patterns"),
        file!("lit"),
        pick(lookups.shadows, file!("shadow_filter"), file!("shadow_off")),
        pick(lookups.mirror, file!("mirror_seen"), file!("mirror_off")),
        pick(
            lookups.occlusion,
            file!("occlusion"),
            file!("occlusion_off"),
        ),
    ]
    .concat()
}

/// What the floor mirrors.
pub(crate) fn mirror() -> String {
    [
        file!("common"),
        file!("lighting"),
        file!("look"),
        file!("mirror"),
        file!("shadow_off"),
    ]
    .concat()
}

/// One colour a face, and pictures on some where a frame has any.
pub(crate) fn flat(has_pictures: bool) -> String {
    let mut texts = vec![
        file!("common"),
        file!("lighting"),
        file!("shadow_off"),
        file!("flat"),
    ];
    if has_pictures {
        texts.extend([file!("look"), file!("picture")]);
    }
    texts.concat()
}

/// The depth of an eye with so many samples to a pixel, in an image with one.
pub(crate) fn depth(samples: u32) -> String {
    let read = if samples > 1 {
        file!("depth_many")
    } else {
        file!("depth_one")
    };
    [file!("depth"), read].concat()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::uniforms::{EyeRaw, LampRaw, LightingRaw, PictureRaw, VignetteRaw};
    use wgpu::naga;

    fn all() -> Vec<(String, String)> {
        let mut all = vec![
            ("shadow".to_owned(), SHADOW.to_owned()),
            ("shrink".to_owned(), SHRINK.to_owned()),
            ("present".to_owned(), PRESENT.to_owned()),
            ("hidden".to_owned(), HIDDEN.to_owned()),
            ("vignette".to_owned(), VIGNETTE.to_owned()),
            ("mirror".to_owned(), mirror()),
            ("flat".to_owned(), flat(false)),
            ("flat with pictures".to_owned(), flat(true)),
            ("depth of one sample".to_owned(), depth(1)),
            ("depth of many samples".to_owned(), depth(4)),
        ];
        for bits in 0..8 {
            let lookups = Lookups {
                shadows: bits & 1 != 0,
                mirror: bits & 2 != 0,
                occlusion: bits & 4 != 0,
            };
            all.push((format!("{lookups:?}"), lit(lookups)));
        }
        all
    }

    fn parsed(name: &str, text: &str) -> naga::Module {
        naga::front::wgsl::parse_str(text)
            .unwrap_or_else(|error| panic!("{name}: {}", error.emit_to_string(text)))
    }

    fn size_of_struct(module: &naga::Module, name: &str) -> Option<usize> {
        module.types.iter().find_map(|(_, ty)| match &ty.inner {
            naga::TypeInner::Struct { span, .. } if ty.name.as_deref() == Some(name) => {
                Some(*span as usize)
            }
            _ => None,
        })
    }

    #[test]
    fn every_pass_parses_and_validates() {
        use naga::valid::{Capabilities, ValidationFlags, Validator};
        for (name, text) in all() {
            let module = parsed(&name, &text);
            Validator::new(ValidationFlags::all(), Capabilities::empty())
                .validate(&module)
                .unwrap_or_else(|error| panic!("{name}: {error:?}"));
        }
    }

    #[test]
    fn a_lookup_that_is_off_binds_nothing() {
        let bound = |lookups: Lookups| {
            let module = parsed("lit", &lit(lookups));
            let mut names: Vec<String> = module
                .global_variables
                .iter()
                .filter(|(_, variable)| variable.binding.is_some())
                .filter_map(|(_, variable)| variable.name.clone())
                .collect();
            names.sort();
            names
        };
        let plain = ["base_sampler", "base_texture", "eye", "lighting"];
        let occlusion = Lookups {
            occlusion: true,
            ..Lookups::default()
        };
        assert_eq!(bound(Lookups::default()), plain);
        assert_eq!(bound(occlusion), plain);
        assert!(!lit(Lookups::default()).contains("lighting.occluders["));
        let shadows = Lookups {
            shadows: true,
            ..Lookups::default()
        };
        assert_eq!(bound(shadows).len(), plain.len() + 2);
        let mirror = Lookups {
            mirror: true,
            ..Lookups::default()
        };
        assert_eq!(bound(mirror).len(), plain.len() + 2);
        let textures = |has_pictures| {
            let module = parsed("flat", &flat(has_pictures));
            let variables = module.global_variables.iter();
            variables
                .filter(|(_, variable)| variable.space == naga::AddressSpace::Handle)
                .count()
        };
        // A picture and its sampler.
        assert_eq!([textures(false), textures(true)], [0, 2]);
    }

    #[test]
    fn structs_have_the_same_size_on_both_sides() {
        let lit = parsed("lit", &lit(Lookups::default()));
        assert_eq!(size_of_struct(&lit, "Eye"), Some(size_of::<EyeRaw>()));
        assert_eq!(size_of_struct(&lit, "Lamp"), Some(size_of::<LampRaw>()));
        assert_eq!(
            size_of_struct(&lit, "Lighting"),
            Some(size_of::<LightingRaw>())
        );
        let present = parsed("present", PRESENT);
        assert_eq!(
            size_of_struct(&present, "Picture"),
            Some(size_of::<PictureRaw>())
        );
        let vignette = parsed("vignette", VIGNETTE);
        assert_eq!(
            size_of_struct(&vignette, "Vignette"),
            Some(size_of::<VignetteRaw>())
        );
    }
}
