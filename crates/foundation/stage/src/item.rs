//! The name of one item of a step, and the path under `steps/` that it gets.

use std::fmt;
use std::path::PathBuf;

use biplane_artifact::ContentHasher;

/// Longest name of a file or folder made from a part of an item's name, bytes. File systems allow 255.
const LONGEST: usize = 120;

/// Which item of a step: its parts, such as trial, frame and body. A step that does not map has the item of no parts.
///
/// Items of one step have the same number of parts: `lunge` and `lunge/0017` cannot both be a name in `steps/`. On a file
/// system that ignores case, items that differ in case alone share a link there; their entries stay apart.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct Item(Vec<String>);

impl Item {
    /// From its parts. A part may be any text: what a file name cannot hold is escaped.
    pub fn of<T: Into<String>>(parts: impl IntoIterator<Item = T>) -> Self {
        Self(parts.into_iter().map(Into::into).collect())
    }

    /// The one item of a step that does not map.
    pub fn whole() -> Self {
        Self::default()
    }

    /// Its parts.
    pub fn parts(&self) -> &[String] {
        &self.0
    }
}

/// `lunge/0017/femur` is the item of three parts.
impl From<&str> for Item {
    fn from(text: &str) -> Self {
        if text.is_empty() { Self::whole() } else { Self::of(text.split('/')) }
    }
}

impl fmt::Display for Item {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0.join("/"))
    }
}

/// `<step>/<part>/<part>`, each one safe name.
pub(crate) fn relative_path(step: &str, item: &Item) -> PathBuf {
    std::iter::once(step).chain(item.0.iter().map(String::as_str)).map(file_name).collect()
}

/// A file name for any text, different for different texts: letters, digits, `-`, `_` and inner dots stay, every other
/// character becomes its bytes as `%2F`. A name that gets too long keeps its beginning and ends in `%~` and a hash.
fn file_name(text: &str) -> String {
    let mut name = String::new();
    let last = text.chars().count().saturating_sub(1);
    for (i, c) in text.chars().enumerate() {
        if c.is_alphanumeric() || "-_".contains(c) || (c == '.' && i != 0 && i != last) {
            name.push(c);
        } else {
            let mut bytes = [0; 4];
            name.extend(c.encode_utf8(&mut bytes).bytes().map(|b| format!("%{b:02X}")));
        }
    }
    if name.is_empty() {
        return "%~".to_owned();
    }
    if name.len() > LONGEST {
        let hash = ContentHasher::new("name", 0).text(text).finish().to_hex();
        let end = (0..=LONGEST / 2).rev().find(|end| name.is_char_boundary(*end)).unwrap_or(0);
        name = format!("{}%~{}", &name[..end], &hash[..32]);
    }
    name
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;
    use std::path::Component;

    #[test]
    fn no_name_escapes_its_folder() {
        for hostile in
            ["../../x", "..", ".", "", "/etc/passwd", "C:\\x", "a/../../b", "\0", "~", "-rf", "..%2F.."]
        {
            let path = relative_path(hostile, &Item::of([hostile, hostile]));
            let components: Vec<_> = path.components().collect();
            assert_eq!(components.len(), 3, "{path:?}");
            assert!(components.iter().all(|c| matches!(c, Component::Normal(_))), "{path:?}");
            assert!(
                relative_path("s", &Item::from(hostile))
                    .components()
                    .all(|c| matches!(c, Component::Normal(_)))
            );
        }
    }

    #[test]
    fn different_names_stay_different() {
        let long = "x".repeat(300);
        let texts = [
            "",
            ".",
            "..",
            "a",
            "a.",
            ".a",
            "a.b",
            "a/b",
            "a%2Fb",
            "a b",
            "%",
            "%~",
            "a\\b",
            "ä",
            "a\u{308}",
            &long,
            &long[1..],
            &"é".repeat(100),
            &"/".repeat(100),
            &"/".repeat(101),
        ];
        let names: HashSet<String> = texts.iter().map(|t| file_name(t)).collect();
        assert_eq!(names.len(), texts.len(), "{names:?}");
        assert!(names.iter().all(|n| n.len() <= LONGEST), "{names:?}");
        assert_ne!(
            relative_path("s", &Item::of(["t/1", "femur"])),
            relative_path("s", &Item::of(["t", "1/femur"]))
        );
        assert_eq!(
            relative_path("match", &Item::from("lunge/0017/femur.v2")).to_str(),
            Some("match/lunge/0017/femur.v2")
        );
    }
}
