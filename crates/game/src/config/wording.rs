//! What a parser says, in the words of somebody who writes settings.

/// The longest piece of somebody's text that an error repeats, in characters.
const LONGEST: usize = 60;

/// `text`, cut where it would drown the sentence that it stands in.
pub(super) fn shortened(text: &str) -> String {
    if text.chars().count() <= LONGEST {
        return text.to_owned();
    }
    let start: String = text.chars().take(LONGEST / 2).collect();
    format!("{start}...")
}

/// A number with as many digits as a person reads: very large and small ones with an exponent.
pub(super) fn number(value: f64) -> String {
    if value == 0.0 || !value.is_finite() || (1e-6..1e9).contains(&value.abs()) {
        value.to_string()
    } else {
        format!("{value:e}")
    }
}

/// The sentence for what serde says about a value.
///
/// Messages that are not recognised stay as they are: a sentence too technical is better than none.
pub(super) fn of_serde(message: &str) -> String {
    let message = message.lines().next().unwrap_or_default();
    let plain = wrong_type(message)
        .or_else(|| unknown(message))
        .or_else(|| missing(message));
    plain.unwrap_or_else(|| shortened(message))
}

fn wrong_type(message: &str) -> Option<String> {
    let rest = message
        .strip_prefix("invalid type: ")
        .or_else(|| message.strip_prefix("invalid value: "))?;
    let (found, expected) = rest.rsplit_once(", expected ")?;
    Some(format!(
        "{} does not fit; give {}",
        found_value(found),
        wanted(expected)
    ))
}

/// The value as it was written.
fn found_value(found: &str) -> String {
    if let Some(text) = found.strip_prefix("string ") {
        return format!("the text {}", shortened(text));
    }
    let quoted = found
        .split_once('`')
        .map(|(_, rest)| rest.trim_end_matches('`'));
    match (found, quoted) {
        (_, Some(value)) => shortened(value),
        ("map", None) => "a table".to_owned(),
        ("sequence", None) => "a list".to_owned(),
        _ => "this value".to_owned(),
    }
}

/// What belongs there.
fn wanted(expected: &str) -> &str {
    match expected {
        "f64" | "f32" => "a number",
        "u8" | "u16" | "u32" | "u64" | "usize" => "a whole number that is not negative",
        "a boolean" => "true or false",
        "a sequence" => "a list",
        "a string" | "string only" => "a text in quotes",
        other if other.starts_with("struct ") => "a table of keys",
        other if other.contains("string or") || other.starts_with("enum ") => "a text in quotes",
        other => other,
    }
}

fn unknown(message: &str) -> Option<String> {
    if let Some(rest) = message.strip_prefix("unknown field ") {
        let known = rest.split_once(", expected ").map(|(_, known)| known)?;
        let known = known.strip_prefix("one of ").unwrap_or(known);
        return Some(format!("there is no such key; the table has {known}"));
    }
    let rest = message.strip_prefix("unknown variant ")?;
    let (found, possible) = rest.split_once(", expected ")?;
    Some(format!(
        "{} does not fit; give {possible}",
        shortened(found)
    ))
}

fn missing(message: &str) -> Option<String> {
    let key = message.strip_prefix("missing field ")?;
    Some(format!("{key} is missing; add it"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parsers_sentences_become_plain_ones() {
        for (said, plain) in [
            (
                "invalid type: string \"high\", expected f64",
                "the text \"high\" does not fit; give a number",
            ),
            (
                "invalid value: integer `-3`, expected u32",
                "-3 does not fit; give a whole number that is not negative",
            ),
            (
                "invalid type: integer `3`, expected struct ObjectsConfig",
                "3 does not fit; give a table of keys",
            ),
            (
                "invalid type: map, expected a sequence",
                "a table does not fit; give a list",
            ),
            (
                "unknown variant `cube`, expected `true` or `ellipsoid`",
                "`cube` does not fit; give `true` or `ellipsoid`",
            ),
            (
                "unknown field `a`, expected one of `b`, `c`",
                "there is no such key; the table has `b`, `c`",
            ),
            ("missing field `rg_m`", "`rg_m` is missing; add it"),
        ] {
            assert_eq!(of_serde(said), plain);
        }
    }

    #[test]
    fn long_numbers_are_shortened() {
        assert_eq!(number(1e300), "1e300");
        assert_eq!(number(-0.25), "-0.25");
        assert_eq!(number(f64::NAN), "NaN");
        assert_eq!(shortened(&"1".repeat(301)).len(), LONGEST / 2 + 3);
        assert_eq!(shortened("short"), "short");
    }
}
