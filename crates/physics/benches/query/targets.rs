//! The targets for the speed of a query.

use crate::judge::cases::Class;

/// What one measured time has to keep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// At most parry's time divided by this.
    Ratio(f64),
    /// At most this many nanoseconds.
    Nanos(f64),
}

impl Target {
    /// Whether `ours` keeps it [ns both].
    pub fn met(self, ours: f64, parry: f64) -> bool {
        match self {
            Target::Ratio(ratio) => ours * ratio <= parry,
            Target::Nanos(limit) => ours <= limit,
        }
    }
}

impl std::fmt::Display for Target {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        match self {
            Target::Ratio(ratio) => write!(f, "{ratio}x"),
            Target::Nanos(limit) => write!(f, "{limit} ns"),
        }
    }
}

/// Targets of a pair and class: from a cold start and from a warm one.
pub fn targets(pair: (&str, &str), class: Class) -> (Option<Target>, Option<Target>) {
    let has = |kind: &str| pair.0.starts_with(kind) || pair.1.starts_with(kind);
    let cold = |ratio| (Some(Target::Ratio(ratio)), None);
    let warm = |ratio| (None, Some(Target::Ratio(ratio)));
    let both = |a, b| (Some(a), Some(b));
    if has("lane") {
        return both(Target::Nanos(60.0), Target::Nanos(60.0));
    }
    if has("cloud") {
        return both(Target::Ratio(1.0), Target::Ratio(1.0));
    }
    if class == Class::Far {
        return both(Target::Nanos(25.0), Target::Nanos(25.0));
    }
    if has("ball") {
        return both(Target::Ratio(2.0), Target::Ratio(2.0));
    }
    match (class, pair) {
        (Class::Near, ("ell", "ell")) => cold(19.0),
        (Class::Touching, ("ell", "ell")) => cold(28.0),
        (_, ("ell", "ell")) => cold(43.0),
        (Class::Near, _) if has("box") => cold(5.0),
        (Class::Touching, _) if has("box") => warm(10.0),
        (_, _) if has("box") => both(Target::Ratio(5.0), Target::Ratio(15.0)),
        (Class::Near, _) => cold(8.0),
        (Class::Touching, _) => warm(15.0),
        (_, _) if has("ell") => both(Target::Ratio(15.0), Target::Ratio(25.0)),
        (_, _) => both(Target::Ratio(8.0), Target::Ratio(25.0)),
    }
}
