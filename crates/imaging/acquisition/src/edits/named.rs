//! Which body a name in a file means.

/// Letters and digits in lower case, anything else as one `_`: what survives the programs that a name goes through.
fn plain(name: &str) -> String {
    let mut out = String::new();
    for c in name.trim().chars().flat_map(char::to_lowercase) {
        if c.is_alphanumeric() {
            out.push(c);
        } else if !out.ends_with('_') {
            out.push('_');
        }
    }
    out
}

/// Whether two names are the same but for case and signs.
pub(super) fn alike(a: &str, b: &str) -> bool {
    plain(a) == plain(b)
}

/// The body that a layer or a piece is named after: alike, alike but for case and signs, or so with a number behind.
pub(super) fn body_of(name: &str, bodies: &[&str]) -> Option<usize> {
    let exact = bodies.iter().position(|b| *b == name.trim());
    let alike = |name: &str| bodies.iter().position(|b| plain(b) == name);
    let name = plain(name);
    let numbered = name.trim_end_matches(|c: char| c.is_ascii_digit());
    exact.or_else(|| alike(&name)).or_else(|| alike(numbered.trim_end_matches('_')))
}

/// The bodies as a message lists them, the nearest to `name` as a question.
pub(super) fn known(name: &str, bodies: &[&str]) -> String {
    let list = bodies.iter().map(|b| format!("`{b}`")).collect::<Vec<_>>().join(", ");
    let word = plain(name);
    let near = bodies.iter().map(|b| (strsim::damerau_levenshtein(&word, &plain(b)), b)).min();
    match near {
        Some((steps, body)) if !word.is_empty() && 2 * steps <= plain(body).chars().count() => {
            format!("the trial has {list}; is `{body}` meant?")
        }
        _ => format!("the trial has {list}"),
    }
}

/// A name as an `id` of XML can be.
pub(super) fn id_of(name: &str) -> String {
    let sign = |c: char| if c.is_ascii_alphanumeric() || "_-.".contains(c) { c } else { '_' };
    let id: String = name.chars().map(sign).collect();
    if id.starts_with(|c: char| c.is_ascii_alphabetic()) { id } else { format!("b_{id}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_survive_what_programs_do_to_them() {
        let bodies = ["femoral component", "tray", "tray 2"];
        for (name, body) in [
            ("femoral component", Some(0)),
            ("Femoral_Component", Some(0)),
            ("femoral_component-7", Some(0)),
            ("tray 2", Some(2)),
            ("tray-2", Some(2)),
            ("tray_3", Some(1)),
            ("layer1", None),
            ("tra", None),
        ] {
            assert_eq!(body_of(name, &bodies), body, "{name}");
        }
        assert!(known("femoral_komponent", &bodies).ends_with("is `femoral component` meant?"));
        assert_eq!(id_of("7 é"), "b_7__");
    }
}
