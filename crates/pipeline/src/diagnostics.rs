//! Errors and warnings that point at a line of `pipeline.toml`.
//!
//! Every problem found is shown, not only the first; each one carries what is wrong, what was meant and what to do. The
//! text is rendered by `annotate-snippets`: `file:line:column`, the line itself and a caret, coloured on a terminal.

use std::ops::Range;
use std::path::{Path, PathBuf};

use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};

use crate::study::SET_FOR_EACH_BODY;

/// One thing that is wrong in a file, and where.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Problem {
    /// What is wrong, one line.
    pub title: String,
    /// Where, in bytes of the file; `None` where no line is to blame.
    pub span: Option<Range<usize>>,
    /// A few words at the caret; may be empty.
    pub label: String,
    /// What to do.
    pub help: Vec<String>,
}

impl Problem {
    /// A problem at a place of the file.
    pub fn at(span: Range<usize>, title: impl Into<String>) -> Self {
        Self { title: title.into(), span: Some(span), label: String::new(), help: Vec::new() }
    }

    /// The same with words at the caret.
    pub fn label(mut self, label: impl Into<String>) -> Self {
        self.label = label.into();
        self
    }

    /// The same with one more line of advice.
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help.push(help.into());
        self
    }
}

/// What is wrong with one text file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Problems {
    /// The file, as the user named it.
    pub path: PathBuf,
    /// Its text.
    pub text: String,
    /// At least one.
    pub list: Vec<Problem>,
}

impl Problems {
    /// The text for people: `file:line:column`, the line, a caret, advice. `styled` adds colours for a terminal.
    pub fn render(&self, styled: bool) -> String {
        let renderer = if styled { Renderer::styled() } else { Renderer::plain() };
        let path = slashes(&self.path);
        let mut out: Vec<String> = Vec::new();
        for problem in &self.list {
            let title = Level::ERROR.primary_title(problem.title.as_str());
            let mut group = match self.span_of(problem) {
                Some(span) => {
                    let annotation = AnnotationKind::Primary.span(span).label(problem.label.as_str());
                    title.element(Snippet::source(self.text.as_str()).path(&path).annotation(annotation))
                }
                None => Group::with_title(title).element(annotate_snippets::Origin::path(&path)),
            };
            for help in &problem.help {
                group = group.element(Level::HELP.message(help.as_str()));
            }
            out.push(renderer.render(&[group]));
        }
        out.join("\n\n")
    }

    /// The span on character boundaries within the text, at most to the end of its first line: a caret under a whole
    /// table says nothing.
    fn span_of(&self, problem: &Problem) -> Option<Range<usize>> {
        let span = problem.span.clone()?;
        let floor = |mut i: usize| {
            i = i.min(self.text.len());
            while !self.text.is_char_boundary(i) {
                i -= 1;
            }
            i
        };
        let start = floor(span.start);
        let end = floor(span.end).max(start);
        let line = self.text[start..end].find('\n').map_or(end, |n| start + n);
        Some(start..line)
    }
}

impl std::fmt::Display for Problems {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.render(false))
    }
}

impl std::error::Error for Problems {}

/// A path with forward slashes, so that messages are the same on every system.
pub fn slashes(path: &Path) -> String {
    path.components().collect::<PathBuf>().display().to_string().replace('\\', "/")
}

/// The candidate nearest to `word`, if it is near enough to be a slip of the fingers.
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let lower = word.to_lowercase();
    candidates
        .into_iter()
        .map(|c| (strsim::damerau_levenshtein(&lower, &c.to_lowercase()), c))
        .filter(|(distance, c)| {
            *distance <= c.chars().count().max(word.chars().count()) / 3 + 1 && *distance < c.len()
        })
        .min()
        .map(|(_, c)| c)
}

/// "did you mean" with the nearest candidate, or the list of all of them.
pub fn meant<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str> + Clone) -> String {
    match nearest(word, candidates.clone()) {
        Some(c) => format!("did you mean `{c}`?"),
        None => {
            let all: Vec<String> = candidates.into_iter().map(|c| format!("`{c}`")).collect();
            if all.is_empty() {
                "none is known here".to_owned()
            } else {
                format!("known here: {}", all.join(", "))
            }
        }
    }
}

/// A problem from what the TOML reader says, with the nearest known word for a misspelt one.
pub fn from_toml(error: &toml::de::Error, text: &str) -> Problem {
    let message = error.message().trim().to_owned();
    let words = message.split('`').skip(1).step_by(2);
    let words: Vec<&str> =
        words.enumerate().filter(|(k, w)| *k == 0 || *w != SET_FOR_EACH_BODY).map(|w| w.1).collect();
    let mut problem =
        Problem { title: message.clone(), span: error.span(), label: String::new(), help: Vec::new() };
    if let (true, Some((found, known))) = (message.starts_with("unknown field"), words.split_first()) {
        problem.title = format!("unknown key `{found}`");
        problem.label = meant(found, known.iter().copied());
        if !known.is_empty() {
            problem = problem.help(format!("the keys of this table are {}", listed(known)));
        }
    } else if let (true, Some((found, known))) = (message.starts_with("unknown variant"), words.split_first())
    {
        problem.title = format!("`{found}` is none of the values this key takes");
        problem.label = meant(found, known.iter().copied());
        problem = problem.help(format!("it takes {}", listed(known)));
    } else if let (true, Some(key)) = (message.starts_with("missing field"), words.first()) {
        problem.title = format!("key `{key}` is missing");
        problem.label = "in this table".to_owned();
        problem = problem.help(match crate::reference::meaning(key) {
            Some(text) => format!("add `{key} = ...`: {text}"),
            None => format!("add `{key} = ...` below this line"),
        });
    } else if message == "duplicate key" {
        let key = error.span().and_then(|s| text.get(s)).unwrap_or_default();
        problem.title = format!("`{key}` is there twice");
        problem.label = "second time".to_owned();
        problem = problem.help(several(key).unwrap_or("keep one of them".to_owned()));
    } else if let (true, Some(key)) =
        (message.ends_with("expected a sequence"), header_of(text, error.span()).and_then(several))
    {
        problem.title = "a study can have several of these".to_owned();
        problem.label = "in single brackets".to_owned();
        problem = problem.help(key);
    } else if message.starts_with("invalid type") || message.starts_with("invalid value") {
        problem.title = message.replace("f64", "a number").replace("u64", "a whole number from 0 up");
        problem.label = "here".to_owned();
    }
    problem
}

/// What to write for a table that a study may have several of.
fn several(key: &str) -> Option<String> {
    ["body", "trial"]
        .contains(&key)
        .then(|| format!("write `[[{key}]]` in double brackets, once for each one"))
}

/// `name` of a header `[name]` at a place of the text.
fn header_of(text: &str, span: Option<Range<usize>>) -> Option<&str> {
    text.get(span?.start..)?.strip_prefix('[')?.split(']').next().map(str::trim)
}

fn listed(words: &[&str]) -> String {
    words.iter().map(|w| format!("`{w}`")).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slip_is_recognised_and_another_word_is_not() {
        assert_eq!(nearest("smothing_px", ["low", "smoothing_px"]), Some("smoothing_px"));
        assert_eq!(nearest("frmaes", ["frames", "starts"]), Some("frames"));
        assert_eq!(nearest("temperature", ["frames", "starts"]), None);
        assert_eq!(meant("C", ["A", "B"]), "known here: `A`, `B`");
    }

    #[test]
    fn a_span_is_cut_to_its_first_line_and_to_whole_characters() {
        let text = "é = 1\nb = 2\n".to_owned();
        let problem = Problem { title: "t".into(), span: Some(1..99), label: String::new(), help: vec![] };
        let problems = Problems { path: "p.toml".into(), text, list: vec![problem.clone()] };
        assert_eq!(problems.span_of(&problem), Some(0..6));
        assert!(problems.render(false).contains("p.toml:1:1"), "{}", problems.render(false));
    }
}
