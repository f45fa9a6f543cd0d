//! The lowest point of a function of one number.

/// Share of an interval by which a golden section shrinks it.
const GOLDEN: f64 = 0.381_966_011_250_105_1;

/// The three best places so far, best first, with their values.
struct Best([(f64, f64); 3]);

impl Best {
    fn insert(&mut self, place: (f64, f64)) {
        let Best([first, second, third]) = self;
        if place.1 <= first.1 {
            (*third, *second, *first) = (*second, *first, place);
        } else if place.1 <= second.1 || second.0 == first.0 {
            (*third, *second) = (*second, place);
        } else if place.1 <= third.1 || third.0 == first.0 || third.0 == second.0 {
            *third = place;
        }
    }

    /// Offset from the best place to the lowest point of the parabola through all three, if it has one.
    fn parabola(&self) -> Option<f64> {
        let Best([(x, fx), (w, fw), (v, fv)]) = *self;
        let (r, q) = ((x - w) * (fx - fv), (x - v) * (fx - fw));
        let (numerator, denominator) = ((x - v) * q - (x - w) * r, 2.0 * (q - r));
        (denominator != 0.0).then(|| -numerator / denominator)
    }
}

/// Where a function that falls, then rises, is lowest on [-edge, edge], and how low: parabolas, and golden sections
/// where these do not shrink fast (Brent 1973). The place is found to within about `precision`.
pub fn lowest(edge: f64, precision: f64, f: impl Fn(f64) -> f64) -> (f64, f64) {
    let (mut low, mut high) = (-edge, edge);
    let start = low + GOLDEN * (high - low);
    let mut best = Best([(start, f(start)); 3]);
    let (mut last_step, mut step_before) = (0.0f64, 0.0f64);
    for _ in 0..200 {
        let x = best.0[0].0;
        let middle = 0.5 * (low + high);
        if (x - middle).abs() <= 2.0 * precision - 0.5 * (high - low) {
            break;
        }
        let parabola = best.parabola().filter(|step| {
            step.abs() < 0.5 * step_before.abs() && x + step > low && x + step < high
        });
        let mut step = match parabola {
            Some(step) => {
                step_before = last_step;
                step
            }
            None => {
                let side = if x < middle { high - x } else { low - x };
                step_before = side;
                GOLDEN * side
            }
        };
        if x + step - low < 2.0 * precision || high - (x + step) < 2.0 * precision {
            step = precision.copysign(middle - x);
        }
        last_step = step;
        if step.abs() < precision {
            step = precision.copysign(step);
        }
        let place = (x + step, f(x + step));
        let (better, other) = if place.1 <= best.0[0].1 {
            (place.0, x)
        } else {
            (x, place.0)
        };
        if other < better {
            low = other;
        } else {
            high = other;
        }
        best.insert(place);
    }
    best.0[0]
}
