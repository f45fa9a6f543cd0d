//! Every shader of the program, put together from the files in `shaders/` by joining texts.

/// A pass's text: the named files of `shaders/`, one after the other.
macro_rules! join {
    ($($file:literal),+) => {
        concat!($(include_str!(concat!("../../../shaders/", $file, ".wgsl"))),+)
    };
}

/// Depth as the shadowing light sees it.
pub(crate) const SHADOW: &str = join!("common", "shadow");
/// Lit surfaces with filtered shadows.
pub(crate) const LIT_SHADOWED: &str = join!("common", "lit", "shadow_filter");
/// Lit surfaces when shadows are off: no map is bound and none is read.
pub(crate) const LIT: &str = join!("common", "lit", "shadow_off");
/// Images into rectangles of the window.
pub(crate) const PRESENT: &str = join!("present");

#[cfg(test)]
mod tests {
    use super::*;
    use crate::uniforms::{EyeRaw, LampRaw, LightingRaw, PictureRaw};
    use wgpu::naga;

    const ALL: [(&str, &str); 4] = [
        ("shadow", SHADOW),
        ("lit with shadows", LIT_SHADOWED),
        ("lit", LIT),
        ("present", PRESENT),
    ];

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
        for (name, text) in ALL {
            let module = parsed(name, text);
            Validator::new(ValidationFlags::all(), Capabilities::empty())
                .validate(&module)
                .unwrap_or_else(|error| panic!("{name}: {error:?}"));
        }
    }

    #[test]
    fn structs_have_the_same_size_on_both_sides() {
        let lit = parsed("lit", LIT_SHADOWED);
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
    }
}
