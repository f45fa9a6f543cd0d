//! Which layer wrote which key, and on which line: what an error blames.

use std::collections::BTreeMap;

use toml::de::{DeTable, DeValue};

use super::layers::{ConfigError, Layer, line_of};

/// Where a value was written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Origin {
    layer: usize,
    line: usize,
}

/// The last place of every key.
#[derive(Debug, Default)]
pub(super) struct Origins(BTreeMap<String, Origin>);

impl Origins {
    /// Notes every key of layer number `layer`.
    pub(super) fn remember(&mut self, table: &DeTable<'_>, text: &str, layer: usize) {
        self.table(table, text, "", layer);
    }

    /// The sentence for a bad key, with the place that wrote it last.
    ///
    /// A relation between keys is broken by the one that was set last: of `key` and `related`, the strongest layer's
    /// place is named.
    pub(super) fn blame(
        &self,
        layers: &[Layer],
        key: &str,
        related: &[&str],
        problem: &str,
    ) -> ConfigError {
        let own = self.nearest(key);
        let others = related.iter().filter_map(|other| self.nearest(other));
        let stronger = others
            .max()
            .filter(|other| own.is_none_or(|own| other.layer > own.layer));
        let place = match (stronger.or(own), layers.first()) {
            (Some(origin), _) => layers[origin.layer].place(origin.line),
            (None, Some(weakest)) => weakest.name(),
            (None, None) => "configuration".to_owned(),
        };
        ConfigError {
            place,
            problem: format!("key `{key}`: {problem}"),
        }
    }

    /// Where `key` was written; a missing one was written nowhere, but its table may have been.
    fn nearest(&self, key: &str) -> Option<Origin> {
        let mut known = key;
        loop {
            if let Some(origin) = self.0.get(known) {
                return Some(*origin);
            }
            known = &known[..known.rfind(['.', '['])?];
        }
    }

    fn table(&mut self, table: &DeTable<'_>, text: &str, path: &str, layer: usize) {
        for (key, value) in table {
            let dot = if path.is_empty() { "" } else { "." };
            let path = format!("{path}{dot}{}", key.get_ref());
            let line = line_of(text, key.span().start);
            self.value(value.get_ref(), text, &path, Origin { layer, line });
        }
    }

    /// Notes one value and, in tables and arrays, those within.
    fn value(&mut self, value: &DeValue<'_>, text: &str, path: &str, origin: Origin) {
        let layer = origin.layer;
        match value {
            DeValue::Table(table) => self.table(table, text, path, layer),
            DeValue::Array(items) => {
                for (index, item) in items.iter().enumerate() {
                    let line = line_of(text, item.span().start);
                    let path = format!("{path}[{index}]");
                    self.value(item.get_ref(), text, &path, Origin { layer, line });
                }
            }
            _ => {}
        }
        self.0.insert(path.to_owned(), origin);
    }
}
