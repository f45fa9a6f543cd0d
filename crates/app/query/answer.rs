//! An answer to a line of JSON, with numbers that read back to the same bits.

use std::fmt::{self, Display, Formatter, Write};

use glam::DVec3;
use physics::query::{Apart, Limits, Manifold, Separation, apart, manifold, separation};

use super::parse::Placed;
use crate::args::Question;

/// What was found out about two shapes.
pub enum Answer {
    Apart(Option<Apart>),
    Gap(Separation),
    Contact(Separation, Manifold),
}

/// Asks the detection.
pub fn answer((a, b): &(Placed, Placed), question: Question, limits: Limits) -> Answer {
    let (a, b) = ((&a.0, &a.1), (&b.0, &b.1));
    match question {
        Question::Apart => Answer::Apart(apart(a, b, None, limits)),
        Question::Gap => Answer::Gap(separation(a, b, None, limits)),
        Question::Contact => {
            let found = separation(a, b, None, limits);
            Answer::Contact(found, manifold(a, b, &found))
        }
    }
}

impl Answer {
    /// Whether all numbers are some; sizes near the end of what numbers can hold leave none.
    pub fn is_finite(&self) -> bool {
        let found = |s: &Separation| {
            let bounds = s.gap.is_finite() && s.upper.is_none_or(f64::is_finite);
            bounds && s.normal.is_finite() && s.point_a.is_finite() && s.point_b.is_finite()
        };
        match self {
            Answer::Apart(None) => true,
            Answer::Apart(Some(apart)) => {
                apart.normal.is_finite() && apart.gap_at_least.is_finite()
            }
            Answer::Gap(s) => found(s),
            Answer::Contact(s, m) => {
                let points = m.points();
                found(s)
                    && points
                        .iter()
                        .all(|p| p.point.is_finite() && p.depth.is_finite())
            }
        }
    }
}

impl Display for Answer {
    /// One JSON object without a line end.
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        match self {
            Answer::Apart(None) => {
                f.write_str(r#"{"apart":false,"normal":null,"gap_at_least":null}"#)
            }
            Answer::Apart(Some(apart)) => {
                let (normal, gap) = (vector(apart.normal), Number(apart.gap_at_least));
                write!(
                    f,
                    r#"{{"apart":true,"normal":{normal},"gap_at_least":{gap}}}"#
                )
            }
            Answer::Gap(found) => write!(f, "{{{}}}", Found(found)),
            Answer::Contact(found, manifold) => {
                write!(
                    f,
                    r#"{{{},"depth":{},"points":["#,
                    Found(found),
                    Number(-found.gap)
                )?;
                for (k, p) in manifold.points().iter().enumerate() {
                    let comma = if k > 0 { "," } else { "" };
                    let (point, depth) = (vector(p.point), Number(p.depth));
                    write!(f, r#"{comma}{{"point":{point},"depth":{depth}}}"#)?;
                }
                f.write_str("]}")
            }
        }
    }
}

/// The keys that a gap and a contact have in common.
struct Found<'a>(&'a Separation);

impl Display for Found<'_> {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        let found = self.0;
        let gap = Number(found.gap);
        write!(f, r#""gap":{gap},"lower":{gap},"upper":"#)?;
        match found.upper {
            Some(upper) => write!(f, "{}", Number(upper))?,
            None => f.write_str("null")?,
        }
        let (normal, point) = (vector(found.normal), vector(found.contact().point));
        let (iterations, capped) = (found.iterations, found.capped);
        write!(
            f,
            r#","normal":{normal},"point":{point},"iterations":{iterations},"capped":{capped}"#
        )
    }
}

/// `[x,y,z]`
fn vector(v: DVec3) -> String {
    format!("[{},{},{}]", Number(v.x), Number(v.y), Number(v.z))
}

/// A finite number in 17 significant digits, which is enough to tell any two apart; no minus before a zero.
struct Number(f64);

impl Display for Number {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        let mut text = String::new();
        write!(text, "{:.16e}", self.0 + 0.0)?;
        let exponent = text.split_once('e').and_then(|(_, e)| e.parse().ok());
        match exponent {
            // As people write it; far from 1 the power of ten is easier to read than zeros.
            Some(e @ -5..16) => write!(f, "{:.*}", (16 - e) as usize, self.0 + 0.0),
            _ => f.write_str(&text),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written(value: f64) -> String {
        Number(value).to_string()
    }

    #[test]
    fn number_has_seventeen_digits() {
        assert_eq!(written(0.5), "0.50000000000000000");
        assert_eq!(written(-12.25), "-12.250000000000000");
        assert_eq!(written(0.1), "0.10000000000000001");
        assert_eq!(written(9.999_999_999_999_999_9), "10.000000000000000");
        assert_eq!(written(1e-13), "1.0000000000000000e-13");
        assert_eq!(written(-0.0), "0.0000000000000000");
        assert_eq!(written(1e300), "1.0000000000000001e300");
    }

    #[test]
    fn number_reads_back_to_the_same_bits() {
        let mut random = experiment::random::SplitMix64::new(3);
        for _ in 0..20_000 {
            let value = f64::from_bits(random.next_u64());
            if value.is_finite() {
                let back: f64 = serde_json::from_str(&written(value)).expect("a number");
                assert_eq!(back, value, "seed 3");
            }
        }
    }
}
