//! Why an item would run.

use std::collections::BTreeSet;
use std::fmt;

use serde_json::Value;

use crate::key::{FORMAT, Record};
use crate::{Damaged, InputHash, InputPart, Item, KeyParts, Stage, Store, StoreError};

/// One reason why an item would run.
#[derive(Debug, Clone, PartialEq)]
pub enum Reason {
    /// There is no earlier result under this step and item.
    NeverRan,
    /// There was one, but its entry was removed.
    Removed,
    /// The entry is there, but not whole.
    Damaged(Damaged),
    /// The entry of the earlier result cannot be read, so what changed since is not known.
    Unreadable {
        /// Why not.
        what: String,
    },
    /// The step was another stage.
    Stage {
        /// Its name then.
        was: String,
        /// Its name now.
        is: String,
    },
    /// The stage's code, or code below it, changed.
    Code,
    /// A parameter changed.
    Parameter {
        /// Its path: `search.radius_mm`, `starts[2]`.
        path: String,
        /// Its value then; none if it did not exist.
        was: Option<Value>,
        /// Its value now; none if it does not exist.
        is: Option<Value>,
    },
    /// An input changed.
    Input(InputDifference),
    /// The stage makes another kind of output, or another schema of it.
    Output,
    /// The store's own layout changed.
    Format,
}

/// What is different about one input.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum InputDifference {
    /// Other content.
    Content {
        /// `start`, or `curves[1]`.
        role: String,
    },
    /// A list has another length.
    Count {
        /// The list.
        role: String,
        /// Its length then.
        was: usize,
        /// Its length now.
        is: usize,
    },
    /// The same list in another order.
    Order {
        /// The list.
        role: String,
    },
    /// It was not an input then, or it is none now, or its kind or schema is another.
    Role {
        /// Which.
        role: String,
    },
}

impl InputDifference {
    /// Which input: `start`, `curves`, or `curves[1]`.
    pub fn role(&self) -> String {
        match self {
            Self::Content { role }
            | Self::Count { role, .. }
            | Self::Order { role }
            | Self::Role { role } => role.clone(),
        }
    }
}

/// Why an item would run, or that it would not.
#[derive(Debug, Clone, PartialEq)]
pub struct Explanation {
    /// The step.
    pub step: String,
    /// The item.
    pub item: Item,
    /// Empty if it is cached.
    pub reasons: Vec<Reason>,
}

impl Explanation {
    /// Whether it would not run.
    pub fn cached(&self) -> bool {
        self.reasons.is_empty()
    }
}

impl Store {
    /// Says why stage `S` would run for this item, by comparing with the entry that `steps/<step>/<item>` leads to.
    ///
    /// # Errors
    /// [`StoreError::Io`].
    pub fn explain<S: Stage>(
        &self,
        step: &str,
        item: &Item,
        parts: &KeyParts,
    ) -> Result<Explanation, StoreError> {
        let reasons = match self.get::<S::Output>(parts.key()) {
            Ok(Some(_)) => Vec::new(),
            Err(StoreError::Damaged(damage)) => vec![Reason::Damaged(damage)],
            Ok(None) => match self.linked(&self.link_path(step, item)) {
                None => vec![Reason::NeverRan],
                Some(earlier) if !self.entry_dir(earlier).exists() => vec![Reason::Removed],
                Some(earlier) => match self.record(earlier) {
                    Ok(record) => differences(&record, parts),
                    Err(what) => vec![Reason::Unreadable { what }],
                },
            },
            Err(e) => return Err(e),
        };
        Ok(Explanation { step: step.to_owned(), item: item.clone(), reasons })
    }
}

fn differences(then: &Record, now: &KeyParts) -> Vec<Reason> {
    let Record { format, stage, code, params, inputs, output } = then;
    let mut reasons = Vec::new();
    if *format != FORMAT {
        reasons.push(Reason::Format);
    }
    if *stage != now.stage {
        reasons.push(Reason::Stage { was: stage.clone(), is: now.stage.clone() });
    }
    if *code != now.code {
        reasons.push(Reason::Code);
    }
    parameter_differences("", Some(params), Some(&now.params.value()), &mut reasons);
    reasons.extend(input_differences(inputs, &now.inputs).into_iter().map(Reason::Input));
    if (&output.kind, output.schema) != (&now.output_kind, now.output_schema) {
        reasons.push(Reason::Output);
    }
    reasons
}

fn parameter_differences(path: &str, was: Option<&Value>, is: Option<&Value>, reasons: &mut Vec<Reason>) {
    match (was, is) {
        (Some(Value::Object(a)), Some(Value::Object(b))) => {
            for name in a.keys().chain(b.keys()).collect::<BTreeSet<_>>() {
                let path = if path.is_empty() { name.clone() } else { format!("{path}.{name}") };
                parameter_differences(&path, a.get(name), b.get(name), reasons);
            }
        }
        (Some(Value::Array(a)), Some(Value::Array(b))) => {
            for i in 0..a.len().max(b.len()) {
                parameter_differences(&format!("{path}[{i}]"), a.get(i), b.get(i), reasons);
            }
        }
        (was, is) if was == is => {}
        (was, is) => {
            reasons.push(Reason::Parameter { path: path.to_owned(), was: was.cloned(), is: is.cloned() })
        }
    }
}

/// In the order of the roles now, then those that are gone.
pub(crate) fn input_differences(then: &[InputPart], now: &[InputPart]) -> Vec<InputDifference> {
    let mut found = Vec::new();
    for part in now {
        let role = &part.role;
        let Some(old) =
            then.iter().find(|p| p.role == *role && p.kind == part.kind && p.schema == part.schema)
        else {
            found.push(InputDifference::Role { role: role.clone() });
            continue;
        };
        match (&old.hash, &part.hash) {
            (a, b) if a == b => {}
            (InputHash::One(_), InputHash::One(_)) => {
                found.push(InputDifference::Content { role: role.clone() })
            }
            (InputHash::List(a), InputHash::List(b)) if a.len() != b.len() => {
                found.push(InputDifference::Count { role: role.clone(), was: a.len(), is: b.len() });
            }
            (InputHash::List(a), InputHash::List(b)) => {
                let sorted = |hashes: &[_]| {
                    let mut hashes = hashes.to_vec();
                    hashes.sort();
                    hashes
                };
                if sorted(a) == sorted(b) {
                    found.push(InputDifference::Order { role: role.clone() });
                } else {
                    let changed = (0..a.len()).filter(|i| a[*i] != b[*i]);
                    found.extend(changed.map(|i| InputDifference::Content { role: format!("{role}[{i}]") }));
                }
            }
            _ => found.push(InputDifference::Role { role: role.clone() }),
        }
    }
    let gone = then.iter().filter(|old| now.iter().all(|part| part.role != old.role));
    found.extend(gone.map(|old| InputDifference::Role { role: old.role.clone() }));
    found
}

impl fmt::Display for Explanation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.step)?;
        if !self.item.parts().is_empty() {
            write!(f, "/{}", self.item)?;
        }
        if self.cached() {
            return f.write_str(": cached");
        }
        for (i, reason) in self.reasons.iter().enumerate() {
            write!(f, "{} {reason}", if i == 0 { ":" } else { ";" })?;
        }
        Ok(())
    }
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NeverRan => f.write_str("never ran"),
            Self::Removed => f.write_str("its entry was removed"),
            Self::Damaged(damage) => write!(f, "entry damaged: {}", damage.what),
            Self::Unreadable { what } => write!(f, "the earlier entry cannot be read: {what}"),
            Self::Stage { was, is } => write!(f, "the step's stage changed from {was} to {is}"),
            Self::Code => f.write_str("the program's code changed"),
            Self::Parameter { path, was: Some(was), is: Some(is) } => {
                write!(f, "parameter {path} changed from {} to {}", Shown(was), Shown(is))
            }
            Self::Parameter { path, was: None, is: Some(is) } => {
                write!(f, "parameter {path} = {} is new", Shown(is))
            }
            Self::Parameter { path, .. } => write!(f, "parameter {path} is gone"),
            Self::Input(difference) => write!(f, "input {difference}"),
            Self::Output => f.write_str("the kind of output changed"),
            Self::Format => f.write_str("the store's format changed"),
        }
    }
}

impl fmt::Display for InputDifference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Content { role } => write!(f, "{role} changed"),
            Self::Count { role, was, is } => write!(f, "{role} has {is} instead of {was}"),
            Self::Order { role } => write!(f, "{role} changed its order"),
            Self::Role { role } => write!(f, "{role} is new, gone or of another kind"),
        }
    }
}

/// JSON, with numbers as people write them: `2`, not `2.0`.
struct Shown<'a>(&'a Value);

impl fmt::Display for Shown<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Value::Number(n) if n.is_f64() => write!(f, "{}", n.as_f64().unwrap_or(f64::NAN)),
            other => write!(f, "{other}"),
        }
    }
}
