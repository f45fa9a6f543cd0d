//! Meshes from Wavefront OBJ files. Materials come from the scene, so `mtllib` is not followed.

use std::cell::Cell;
use std::io::{self, BufRead, Read};
use std::path::Path;

use glam::{Vec2, Vec3};

use crate::{MeshData, RenderError, mesh::Vertex};

impl MeshData {
    /// Reads every object of an OBJ file into one mesh; normals that are not in the file are computed.
    ///
    /// # Errors
    /// One sentence with the file and, where one is to blame, the line: missing file, malformed statement,
    /// index out of range, a coordinate that is not a number, no faces.
    pub fn load_obj(path: &Path) -> Result<Self, RenderError> {
        let fail = |(line, reason)| RenderError::MeshFile {
            path: path.to_owned(),
            line,
            reason,
        };
        let text = std::fs::read_to_string(path)
            .map_err(|error| fail((None, format!("the mesh cannot be read: {error}"))))?;
        parse(&text).map_err(fail)
    }
}

type Blame = (Option<usize>, String);

fn parse(text: &str) -> Result<MeshData, Blame> {
    // tobj takes "nan" for a number and finds a bad index only at the end of an object, too late to name its line.
    if let Some(line) = text.lines().position(holds_no_number) {
        return Err((Some(line + 1), "a coordinate is not a number".to_owned()));
    }
    if let Some((line, index)) = index_out_of_range(text) {
        return Err((
            Some(line),
            format!("the face uses index {index}, which the file does not have"),
        ));
    }
    let lines_read = Cell::new(0);
    let mut reader = LineCounter {
        bytes: text.as_bytes(),
        lines_read: &lines_read,
    };
    let options = tobj::LoadOptions {
        single_index: true,
        triangulate: true,
        ignore_points: true,
        ignore_lines: true,
    };
    let (models, _) = tobj::load_obj_buf(&mut reader, &options, |_| Ok(Default::default()))
        .map_err(|error| {
            let reason = format!("the mesh is malformed: {error}");
            (Some(lines_read.get().max(1)), reason)
        })?;
    let mut mesh = MeshData::default();
    for model in &models {
        append(&mut mesh, &model.mesh);
    }
    if mesh.indices.is_empty() {
        return Err((None, "the mesh has no faces".to_owned()));
    }
    Ok(mesh)
}

fn append(mesh: &mut MeshData, part: &tobj::Mesh) {
    let count = part.positions.len() / 3;
    let has_normals = part.normals.len() == 3 * count;
    let has_uvs = part.texcoords.len() == 2 * count;
    let triple = |values: &[f32], i: usize| Vec3::from_slice(&values[3 * i..]);
    let mut read = MeshData {
        vertices: (0..count)
            .map(|i| Vertex {
                position: triple(&part.positions, i),
                normal: if has_normals {
                    triple(&part.normals, i).try_normalize().unwrap_or(Vec3::Y)
                } else {
                    Vec3::ZERO
                },
                // OBJ counts v upwards from the lower edge, images run downwards from the upper one.
                uv: if has_uvs {
                    Vec2::new(part.texcoords[2 * i], 1.0 - part.texcoords[2 * i + 1])
                } else {
                    Vec2::ZERO
                },
            })
            .collect(),
        indices: part.indices.clone(),
    };
    if !has_normals {
        read.compute_normals();
    }
    let first = mesh.vertices.len() as u32;
    mesh.vertices.append(&mut read.vertices);
    mesh.indices
        .extend(read.indices.iter().map(|index| first + index));
}

fn holds_no_number(line: &str) -> bool {
    let mut words = line.split_whitespace();
    matches!(words.next(), Some("v" | "vn" | "vt"))
        && words.any(|word| word.parse::<f32>().is_ok_and(|value| !value.is_finite()))
}

/// First line of a face with a position index that the file does not have, and that index.
fn index_out_of_range(text: &str) -> Option<(usize, i64)> {
    let positions = text.lines().filter(|line| line.starts_with("v ")).count() as i64;
    text.lines().enumerate().find_map(|(at, line)| {
        let corners = line.strip_prefix("f ")?.split_whitespace();
        corners
            .filter_map(|corner| corner.split('/').next()?.parse::<i64>().ok())
            .find(|&index| index == 0 || index.abs() > positions)
            .map(|index| (at + 1, index))
    })
}

/// Counts the lines that a parser has taken, so that its error can be placed.
struct LineCounter<'a> {
    bytes: &'a [u8],
    lines_read: &'a Cell<usize>,
}

impl Read for LineCounter<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.bytes.len().min(buffer.len());
        buffer[..count].copy_from_slice(&self.bytes[..count]);
        self.consume(count);
        Ok(count)
    }
}

impl BufRead for LineCounter<'_> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        // One line at a time, the last one perhaps without its newline.
        let end = self.bytes.iter().position(|&byte| byte == b'\n');
        Ok(&self.bytes[..end.map_or(self.bytes.len(), |end| end + 1)])
    }

    fn consume(&mut self, count: usize) {
        let (taken, rest) = self.bytes.split_at(count);
        let newlines = taken.iter().filter(|&&byte| byte == b'\n').count();
        let unfinished = usize::from(rest.is_empty() && taken.last().is_some_and(|&b| b != b'\n'));
        self.lines_read
            .set(self.lines_read.get() + newlines + unfinished);
        self.bytes = rest;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n";

    fn blame(text: &str) -> Blame {
        parse(text).expect_err("the text is broken")
    }

    #[test]
    fn parse_reads_positions_uvs_and_computes_normals() {
        let mesh = parse(&format!("{TRIANGLE}f 1/1 2/2 3/3\n")).expect("well-formed");
        assert_eq!(mesh.triangles(), 1);
        assert_eq!(mesh.vertices[1].position, Vec3::X);
        assert_eq!(mesh.vertices[0].normal, Vec3::Z);
        assert_eq!(mesh.vertices[2].uv, Vec2::new(0.0, 0.0), "v runs downwards");
    }

    #[test]
    fn parse_joins_objects_and_splits_polygons() {
        let text = "o a\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1 4//1\n\
                    o b\nf 1//1 2//1 3//1\n";
        let mesh = parse(text).expect("well-formed");
        assert_eq!(mesh.triangles(), 3);
        assert!(mesh.check().is_ok());
    }

    #[test]
    fn parse_names_the_line_of_a_malformed_statement() {
        let (line, reason) = blame("v 0 0 0\nv 1 zero 0\nv 0 1 0\nf 1 2 3\n");
        assert_eq!(line, Some(2));
        assert!(reason.contains("position"), "{reason}");
        let (line, _) = blame(&format!("{TRIANGLE}f 1 x 3"));
        assert_eq!(line, Some(7));
    }

    #[test]
    fn parse_names_the_line_of_a_bad_index() {
        let (line, reason) = blame(&format!("{TRIANGLE}f 1 2 3\nf 1 2 9\no more\n"));
        assert_eq!(line, Some(8));
        assert!(reason.contains("index 9"), "{reason}");
    }

    #[test]
    fn parse_refuses_what_is_not_a_number() {
        let (line, reason) = blame(&format!("{TRIANGLE}vn 0 nan 1\nf 1 2 3\n"));
        assert_eq!(line, Some(7));
        assert!(reason.contains("not a number"), "{reason}");
        assert_eq!(blame("v 0 inf 0\n").0, Some(1));
    }

    #[test]
    fn parse_refuses_an_empty_file() {
        assert!(blame("").1.contains("no faces"));
        assert!(blame("# only a comment\n").1.contains("no faces"));
    }

    #[test]
    fn load_obj_names_a_missing_file() {
        let error = MeshData::load_obj(Path::new("no/such.obj")).expect_err("there is none");
        assert!(error.to_string().starts_with("no/such.obj: "), "{error}");
    }

    #[test]
    fn load_obj_names_file_and_line() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("bad.obj");
        std::fs::write(&path, "v 0 0 0\nv 1 zero 0\n").expect("the folder is writable");
        let text = MeshData::load_obj(&path)
            .expect_err("malformed")
            .to_string();
        assert!(text.contains("bad.obj:2: "), "{text}");
        assert!(!text.contains('\n'), "{text}");
    }
}
