//! What was drawn for a body as pieces: which elements are marks, what they bound, and whether any of it is changed.

use biplane_artifact::EditedContour;
use roxmltree::Node;

use super::{Drawn, Reader, name_of, own};
use crate::edits::chain::{Chain, distance};
use crate::edits::named::{alike, body_of};
use crate::edits::place::Pair;
use crate::edits::shapes;
use crate::edits::trusted::Line;
use crate::edits::{EditError, MAX_POINTS};

/// What a node may be off and still be where it was written: programs keep eight digits, and add up relative steps.
const SAME_PX: f64 = 0.01;
/// How far a mark may be from a piece that has another name, px.
const NEAR_MARK_PX: f64 = 3.0;
/// Which end of the trusted part a mark is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum End {
    From,
    To,
}

impl<'a> Reader<'a> {
    /// The trusted parts of a body's pieces.
    pub(super) fn contour(
        &mut self,
        drawn: &[&Drawn<'a>],
        left: &mut usize,
    ) -> Result<EditedContour, EditError> {
        let mut lines: Vec<(String, Node<'a, 'a>, Line)> = Vec::new();
        for one in drawn.iter().filter(|d| d.mark.is_none()) {
            let name = name_of(one.node).map_or_else(
                || format!("{} of line {}", one.node.tag_name().name(), self.line(one.node)),
                str::to_owned,
            );
            for chain in &one.chains {
                let points = chain.points().map_err(|e| {
                    self.at(
                        one.node,
                        format!("it is not of the size of a picture ({e}); delete it, or draw it anew"),
                    )
                })?;
                *left = left.checked_sub(points.len()).ok_or_else(|| {
                    self.at(one.node, format!("with it the file has more than {MAX_POINTS} px of curves; delete what is no outline"))
                })?;
                lines.push((name.clone(), one.node, Line { points, closed: chain.closed }));
            }
        }
        let mut ends = vec![[None; 2]; lines.len()];
        for one in drawn {
            let Some((of, end)) = &one.mark else { continue };
            let centre = centre(&one.chains);
            let nearest = |named: bool| {
                let own = lines.iter().enumerate().filter(|(_, (name, ..))| !named || alike(name, of));
                let spots =
                    own.filter_map(|(i, (.., line))| line.closest(centre).map(|(far, spot)| (far, i, spot)));
                spots.min_by(|a, b| a.0.total_cmp(&b.0))
            };
            let Some((_, line, spot)) =
                nearest(true).or_else(|| nearest(false).filter(|n| n.0 <= NEAR_MARK_PX))
            else {
                self.note(one.node, "marks a piece that is not there; it is left out");
                continue;
            };
            let slot = &mut ends[line][usize::from(*end == End::To)];
            if slot.replace(spot).is_some() {
                let word = if *end == End::To { "to" } else { "from" };
                return Err(self.at(
                    one.node,
                    format!(
                        "it is the second mark `{word}` of the piece `{}`; delete one of the two",
                        lines[line].0
                    ),
                ));
            }
        }
        let mut pieces = Vec::new();
        for ((name, node, line), [from, to]) in lines.into_iter().zip(ends) {
            let stretches = line.between(from, to).within(self.size);
            let before = pieces.len();
            pieces.extend(stretches.into_iter().filter_map(|s| s.piece(&name)));
            if pieces.len() == before {
                self.note(node, "is outside the picture or shorter than 2 px; it is left out");
            }
        }
        Ok(EditedContour { pieces })
    }
}

impl Drawn<'_> {
    /// Whether nobody changed it since it was written.
    pub(super) fn is_as_written(&self) -> bool {
        let Some(written) = own(self.node, "written").and_then(|d| shapes::path(d).ok()) else {
            return false;
        };
        self.chains.len() == written.len()
            && self.chains.iter().zip(&written).all(|(a, b)| a.is_like(b, SAME_PX))
            || self.mark.is_some() && distance(centre(&self.chains), centre(&written)) <= SAME_PX
    }
}

/// The piece whose trusted part an element marks, and which end of it: as it was written, or by its name `<piece> from` or
/// `<piece> to`, where that is a circle or the piece is named after a body (programs forget what was written).
pub(super) fn mark_of(node: Node<'_, '_>, bodies: &[&str]) -> Option<(String, End)> {
    let end = |word: &str| match word {
        "from" => Some(End::From),
        "to" => Some(End::To),
        _ => None,
    };
    if let (Some(word), Some(of)) = (own(node, "mark"), own(node, "of")) {
        return Some((of.to_owned(), end(word)?));
    }
    let (of, word) = name_of(node)?.rsplit_once([' ', '_', '-'])?;
    let round = matches!(node.tag_name().name(), "circle" | "ellipse");
    (round || body_of(of, bodies).is_some()).then_some((of.to_owned(), end(word)?))
}

/// The centre of the box around nodes: of a circle, however it is written, its own.
fn centre(chains: &[Chain]) -> Pair {
    let nodes = chains.iter().flat_map(|c| std::iter::once(c.start).chain(c.cubics.iter().map(|c| c[2])));
    let (mut low, mut high) = ([f64::MAX; 2], [f64::MIN; 2]);
    for node in nodes {
        for axis in 0..2 {
            low[axis] = low[axis].min(node[axis]);
            high[axis] = high[axis].max(node[axis]);
        }
    }
    [0, 1].map(|axis| (low[axis] + high[axis]) / 2.0)
}
