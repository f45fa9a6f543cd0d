//! A line of JSON to two placed shapes, or one sentence that says what is wrong with it.

use std::collections::HashMap;

use glam::{DQuat, DVec3};
use physics::{Pose, Shape, ShapeError};
use serde_json::{Map, Value};

use super::obj;

/// A shape and where it is: `world_from_shape`.
pub type Placed = (Shape, Pose);

/// The names of the shapes, each with its sizes.
const SHAPES: [(&str, &[&str]); 10] = [
    ("sphere", &["radius"]),
    ("ellipsoid", &["semi_axes"]),
    ("truncated_ellipsoid", &["semi_axes", "cut"]),
    ("capsule", &["radius", "half_height"]),
    ("cylinder", &["radius", "half_height"]),
    ("cone", &["radius", "half_height"]),
    ("frustum", &["radius_bottom", "radius_top", "half_height"]),
    ("box", &["half_extents"]),
    ("half_space", &["normal"]),
    ("cloud", &["points", "file"]),
];
/// Where a shape is; both may be left out.
const POSE: [&str; 2] = ["position", "rotation"];

/// Reads queries; clouds from files are read once.
#[derive(Default)]
pub struct Parser {
    clouds: HashMap<String, Shape>,
}

impl Parser {
    /// The two shapes of a line, a and b.
    ///
    /// # Errors
    /// One sentence without the line's number.
    pub fn query(&mut self, line: &[u8]) -> Result<(Placed, Placed), String> {
        if line.trim_ascii().is_empty() {
            return Err("the line is empty: a query is {\"a\":{...},\"b\":{...}}".to_owned());
        }
        let value: Value = serde_json::from_slice(line).map_err(|error| not_json(&error))?;
        let Value::Object(mut query) = value else {
            let kind = kind(&value);
            return Err(format!(
                "a query is an object with the keys a and b, not {kind}"
            ));
        };
        let mut side = |name: &str| {
            let value = query
                .remove(name)
                .ok_or_else(|| format!("the query has no {name}"))?;
            self.placed(value)
                .map_err(|reason| format!("{name}: {reason}"))
        };
        let (a, b) = (side("a")?, side("b")?);
        if let Some(key) = query.keys().next() {
            return Err(format!("a query has no key {key:?}; it has a and b"));
        }
        if a.0.bounding_radius().is_infinite() && b.0.bounding_radius().is_infinite() {
            return Err("two half-spaces have no finite gap".to_owned());
        }
        Ok((a, b))
    }

    fn placed(&mut self, value: Value) -> Result<Placed, String> {
        let Value::Object(mut keys) = value else {
            return Err(format!("a shape is an object, not {}", kind(&value)));
        };
        let name = match keys.remove("shape") {
            Some(Value::String(name)) => name,
            Some(other) => return Err(format!("shape must be a name, not {}", kind(&other))),
            None => return Err(format!("the key shape is missing; it is {}", shapes())),
        };
        let Some((_, sizes)) = SHAPES.iter().find(|(known, _)| *known == name) else {
            return Err(format!("there is no shape {name:?}; there is {}", shapes()));
        };
        let mut fields = Fields { name: &name, keys };
        fields.refuse_all_but(sizes)?;
        let shape = self.shape(&name, &mut fields)?;
        Ok((shape, fields.pose()?))
    }

    fn shape(&mut self, name: &str, fields: &mut Fields) -> Result<Shape, String> {
        let made = match name {
            "sphere" => Shape::sphere(fields.number("radius")?),
            "ellipsoid" => Shape::ellipsoid(fields.vector("semi_axes")?),
            "truncated_ellipsoid" => {
                Shape::truncated_ellipsoid(fields.vector("semi_axes")?, fields.number("cut")?)
            }
            "capsule" => Shape::capsule(fields.number("radius")?, fields.number("half_height")?),
            "cylinder" => Shape::cylinder(fields.number("radius")?, fields.number("half_height")?),
            "cone" => Shape::cone(fields.number("radius")?, fields.number("half_height")?),
            "frustum" => Shape::frustum(
                fields.number("radius_bottom")?,
                fields.number("radius_top")?,
                fields.number("half_height")?,
            ),
            "box" => Shape::cuboid(fields.vector("half_extents")?),
            "half_space" => {
                let normal = fields.vector("normal")?;
                // Only its direction counts; squares of very small or large numbers would leave the range.
                let largest = normal.abs().max_element();
                Shape::half_space(if largest > 0.0 {
                    normal / largest
                } else {
                    normal
                })
            }
            _ => return self.cloud(fields),
        };
        made.map_err(|error: ShapeError| error.to_string())
    }

    /// A cloud's points stand in the line or in a file.
    fn cloud(&mut self, fields: &mut Fields) -> Result<Shape, String> {
        let made = |points: &[DVec3]| Shape::cloud(points).map_err(|error| error.to_string());
        match (fields.keys.remove("points"), fields.keys.remove("file")) {
            (Some(points), None) => made(&self::points(&points)?),
            (None, Some(Value::String(file))) => {
                if let Some(shape) = self.clouds.get(&file) {
                    return Ok(shape.clone());
                }
                let shape = made(&obj::vertices(file.as_ref())?)?;
                self.clouds.insert(file, shape.clone());
                Ok(shape)
            }
            (None, Some(other)) => Err(format!(
                "file must be the name of an OBJ file, not {}",
                kind(&other)
            )),
            _ => Err("a cloud needs either points or file".to_owned()),
        }
    }
}

/// The keys of one shape that have not been read yet.
struct Fields<'a> {
    name: &'a str,
    keys: Map<String, Value>,
}

impl Fields<'_> {
    fn refuse_all_but(&self, sizes: &[&str]) -> Result<(), String> {
        let known = || sizes.iter().chain(&POSE);
        match self.keys.keys().find(|key| !known().any(|k| k == key)) {
            None => Ok(()),
            Some(key) => {
                let known: Vec<&str> = known().copied().collect();
                Err(format!(
                    "the shape {} has no key {key:?}; it has {}",
                    self.name,
                    known.join(", ")
                ))
            }
        }
    }

    fn take(&mut self, key: &str) -> Result<Value, String> {
        let missing = || format!("the shape {} needs the key {key}", self.name);
        self.keys.remove(key).ok_or_else(missing)
    }

    fn number(&mut self, key: &str) -> Result<f64, String> {
        let value = self.take(key)?;
        let wrong = || format!("{key} must be a number, not {}", kind(&value));
        value.as_f64().ok_or_else(wrong)
    }

    fn vector(&mut self, key: &str) -> Result<DVec3, String> {
        let [x, y, z] = numbers(&self.take(key)?, key, "three numbers [x, y, z]")?;
        Ok(DVec3::new(x, y, z))
    }

    fn pose(&mut self) -> Result<Pose, String> {
        let position = match self.keys.contains_key("position") {
            true => self.vector("position")?,
            false => DVec3::ZERO,
        };
        let rotation = match self.keys.remove("rotation") {
            Some(value) => rotation(&value)?,
            None => DQuat::IDENTITY,
        };
        Ok(Pose::new(position, rotation))
    }
}

/// A quaternion of any length but zero; its direction among the quaternions is the rotation.
fn rotation(value: &Value) -> Result<DQuat, String> {
    let [x, y, z, w] = numbers(value, "rotation", "four numbers [x, y, z, w]")?;
    // Squares of very small or large numbers would leave the range.
    let largest = [x, y, z, w].into_iter().map(f64::abs).fold(0.0, f64::max);
    if largest == 0.0 {
        return Err(
            "rotation is zero, which turns nothing anywhere: no rotation is [0, 0, 0, 1]"
                .to_owned(),
        );
    }
    let scaled = DQuat::from_xyzw(x / largest, y / largest, z / largest, w / largest);
    // A unit quaternion stays as it was given, to the bit.
    let given = DQuat::from_xyzw(x, y, z, w);
    let is_unit = (given.length_squared() - 1.0).abs() <= 4.0 * f64::EPSILON;
    Ok(if is_unit { given } else { scaled.normalize() })
}

fn points(value: &Value) -> Result<Vec<DVec3>, String> {
    let Value::Array(rows) = value else {
        return Err(format!(
            "points must be a list of [x, y, z], not {}",
            kind(value)
        ));
    };
    let point = |(at, row): (usize, &Value)| {
        let [x, y, z] = numbers(row, &format!("point {}", at + 1), "three numbers [x, y, z]")?;
        Ok(DVec3::new(x, y, z))
    };
    rows.iter().enumerate().map(point).collect()
}

fn numbers<const N: usize>(value: &Value, key: &str, wanted: &str) -> Result<[f64; N], String> {
    let given = || match value {
        Value::Array(items) if items.len() != N => format!("{} of them", items.len()),
        Value::Array(items) => items
            .iter()
            .find(|item| !item.is_number())
            .map_or("one that is out of range".to_owned(), |item| {
                format!("{} among them", kind(item))
            }),
        other => kind(other).to_owned(),
    };
    let read = || {
        let items: Option<Vec<f64>> = value.as_array()?.iter().map(Value::as_f64).collect();
        <[f64; N]>::try_from(items?).ok()
    };
    read().ok_or_else(|| format!("{key} must be {wanted}, not {}", given()))
}

fn shapes() -> String {
    let names: Vec<&str> = SHAPES.iter().map(|(name, _)| *name).collect();
    let (last, others) = names.split_last().expect("there are shapes");
    format!("{} or {last}", others.join(", "))
}

fn kind(value: &Value) -> &'static str {
    match value {
        Value::Null => "null",
        Value::Bool(_) => "a truth value",
        Value::Number(_) => "a number",
        Value::String(_) => "a text",
        Value::Array(_) => "a list",
        Value::Object(_) => "an object",
    }
}

/// The reason without the line, which is always the first of the one that was read.
fn not_json(error: &serde_json::Error) -> String {
    let text = error.to_string();
    let reason = text.split(" at line ").next().unwrap_or(&text);
    format!(
        "the line is not JSON: {reason} at column {}",
        error.column()
    )
}
