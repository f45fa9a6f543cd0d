//! The vertices of a Wavefront OBJ file, for clouds.
//!
//! The renderer's reader is not used: it rounds to single precision, wants faces, and a cloud needs neither them nor
//! their order.

use std::path::Path;

use glam::DVec3;

/// All vertices (`v x y z`) of a file, in its units, which are taken for metres.
///
/// # Errors
/// One sentence with the file and, where one is to blame, the line.
pub fn vertices(path: &Path) -> Result<Vec<DVec3>, String> {
    let name = path.display();
    let text = std::fs::read_to_string(path).map_err(|e| format!("{name} cannot be read: {e}"))?;
    let mut vertices = Vec::new();
    for (at, line) in text.lines().enumerate() {
        let mut words = line.split_ascii_whitespace();
        if words.next() != Some("v") {
            continue;
        }
        let mut coordinate = || words.next()?.parse().ok().filter(|x: &f64| x.is_finite());
        let (Some(x), Some(y), Some(z)) = (coordinate(), coordinate(), coordinate()) else {
            return Err(format!(
                "{name}, line {}: a vertex needs three numbers",
                at + 1
            ));
        };
        vertices.push(DVec3::new(x, y, z));
    }
    if vertices.is_empty() {
        return Err(format!(
            "{name} has no vertices: it is read as a Wavefront OBJ file"
        ));
    }
    Ok(vertices)
}
