//! The figures of a comparison, for people and as CSV.

use game::{Config, ObjectShape};

use super::condition::{Condition, Table1};
use super::course::Course;
use super::divergence::Divergence;
use super::thrown::Thrown;
use super::verdict::Edge;

/// Shown where something never happens.
const NEVER: &str = "n/a";

/// Everything about one comparison.
pub struct Comparison<'a> {
    /// What was thrown.
    pub thrown: &'a Thrown,
    /// Under which conditions.
    pub conditions: &'a [Condition],
    /// What came of it, in the order of the conditions.
    pub courses: &'a [Course],
    /// Which condition the others are compared with.
    pub base: usize,
}

impl Comparison<'_> {
    /// How a course parts from the base.
    pub fn divergence(&self, index: usize) -> Divergence {
        Divergence::of(self.thrown, &self.courses[self.base], &self.courses[index])
    }

    /// The table for people.
    pub fn text(&self) -> String {
        let base = &self.conditions[self.base];
        let mut text = format!(
            "{}: ball {} at {:.2} m/s{}\nAgainst {}: ball paths 1 cm apart, 5 degrees apart for the participant's eye, and how far at most\n\n{HEAD}\n",
            self.thrown.name,
            self.thrown.ball + 1,
            self.thrown.linear.length(),
            recorded(self.thrown),
            base.name
        );
        for (index, (condition, course)) in self.conditions.iter().zip(self.courses).enumerate() {
            let objects = &condition.config.objects;
            let parting = self.divergence(index);
            let (apart, seen, most) = if index == self.base {
                ("base".to_owned(), String::new(), String::new())
            } else {
                let most = format!("{:.1} at {:.2}", parting.most_deg, parting.most_at);
                (seconds(parting.apart), seconds(parting.seen), most)
            };
            let hit = course.first_hit;
            text += &format!(
                "{:<12}{:>6.2}{:>9.2}  {:<10}{:>5}{:>9}{apart:>10}{seen:>9}{most:>16}{:>10}{:>8.2}\n",
                condition.name,
                objects.elasticity,
                objects.friction_rate,
                shape(&condition.config),
                course.fallen.len(),
                seconds(hit.map(|hit| hit.time)),
                hit.map_or(NEVER.to_owned(), |hit| format!("{:.2}", hit.impulse)),
                course.impulse,
            );
        }
        text
    }

    /// The table as CSV; `n/a` for what never happens.
    pub fn csv(&self) -> String {
        let mut text = "condition,base,elasticity,friction_rate,shape,fallen_pins,fallen,first_hit_s,apart_1cm_s,apart_5deg_s,\
                        largest_angle_deg,largest_angle_at_s,first_impulse_Ns,total_impulse_Ns\n"
            .to_owned();
        for (index, (condition, course)) in self.conditions.iter().zip(self.courses).enumerate() {
            let objects = &condition.config.objects;
            let parting = self.divergence(index);
            let fallen: Vec<String> = course.fallen.iter().map(u8::to_string).collect();
            let hit = course.first_hit;
            let fields = [
                quoted(&condition.name),
                quoted(&self.conditions[self.base].name),
                objects.elasticity.to_string(),
                objects.friction_rate.to_string(),
                shape(&condition.config).to_owned(),
                fallen.len().to_string(),
                fallen.join(" "),
                number(hit.map(|hit| hit.time)),
                number(parting.apart),
                number(parting.seen),
                number(Some(parting.most_deg)),
                number(Some(parting.most_at)),
                number(hit.map(|hit| hit.impulse)),
                number(Some(course.impulse)),
            ];
            text += &(fields.join(",") + "\n");
        }
        text
    }
}

const HEAD: &str = "\
condition       e friction  shape      pins  hit [s]  1 cm [s]  5 deg [s]  most [deg] [s]  first [Ns]  all [Ns]";

/// The twelve pairs of Table 2 as CSV.
pub fn edges_csv(table: &Table1, edges: &[Edge]) -> String {
    let mut text = "changed,from,to,apart_1cm_s,apart_5deg_s,largest_angle_deg,largest_angle_at_s,between_first_hits_s,from_pins,to_pins\n".to_owned();
    for edge in edges {
        let parting = &edge.divergence;
        let fields = [
            table.factors[edge.factor].name.clone(),
            edge.names[0].clone(),
            edge.names[1].clone(),
            number(parting.apart),
            number(parting.seen),
            number(Some(parting.most_deg)),
            number(Some(parting.most_at)),
            number(Some(edge.between_hits()).filter(|time| time.is_finite())),
            edge.pins[0].to_string(),
            edge.pins[1].to_string(),
        ];
        text += &(fields.join(",") + "\n");
    }
    text
}

/// What the recording says itself.
fn recorded(thrown: &Thrown) -> String {
    thrown.fallen.map_or(String::new(), |pins| {
        format!(
            ", {pins} of {} pins when it was recorded",
            thrown.pins.len()
        )
    })
}

/// The name of a condition's shape in the configuration.
pub fn shape(config: &Config) -> &'static str {
    match config.objects.shape {
        ObjectShape::True => "true",
        ObjectShape::Ellipsoid => "ellipsoid",
    }
}

fn seconds(time: Option<f64>) -> String {
    time.map_or(NEVER.to_owned(), |time| format!("{time:.2}"))
}

/// A number of a CSV file: six digits after the point, which is finer than a step.
pub fn number(value: Option<f64>) -> String {
    value.map_or(NEVER.to_owned(), |value| format!("{value:.6}"))
}

/// A name as a field of a CSV file.
pub fn quoted(name: &str) -> String {
    if name.contains([',', '"', '\n']) {
        format!("\"{}\"", name.replace('"', "\"\""))
    } else {
        name.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quoted_doubles_quotes() {
        assert_eq!(quoted("plain"), "plain");
        assert_eq!(quoted("a, \"b\""), "\"a, \"\"b\"\"\"");
    }
}
