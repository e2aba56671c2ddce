//! What the marks on a picture mean, and how many there are of each.

use super::colours::{FAINT, INK};
use super::sheet::TEXT;
use super::svg::{Font, Style, Svg};

/// The look of a mark.
#[derive(Debug, Clone, Copy)]
pub(super) enum Mark {
    /// A circle.
    Ring,
    /// A diagonal cross.
    Cross,
    /// An arrow.
    Arrow,
}

/// One line: the mark, its colour, what it means, how many there are (none for marks that are not counted).
pub(super) type Entry<'a> = (Mark, &'a str, &'a str, Option<usize>);

/// Lines of marks from `corner` down; returns where they end. Kinds that are not in the picture are faint.
pub(super) fn legend(svg: &mut Svg, corner: [f64; 2], entries: &[Entry]) -> f64 {
    let [x, mut y] = corner;
    for (mark, colour, meaning, number) in entries {
        svg.group(Style::area("swatch", "#3a3f45"), |svg| svg.rectangle([x, y], [26.0, 20.0]));
        let middle = [x + 13.0, y + 10.0];
        svg.group(Style::line("sample", colour, 2.0), |svg| match mark {
            Mark::Ring => svg.circle(middle, 6.0),
            Mark::Cross => svg.cross(middle, 5.0),
            Mark::Arrow => {
                let [left, tip] = [[x + 5.0, y + 10.0], [x + 21.0, y + 10.0]];
                let head = vec![[tip[0] - 6.0, tip[1] - 4.0], tip, [tip[0] - 6.0, tip[1] + 4.0]];
                svg.strokes(&[vec![left, tip], head], false);
            }
        });
        let text = number.map_or((*meaning).to_owned(), |n| format!("{meaning}: {n}"));
        let ink = if *number == Some(0) { FAINT } else { INK };
        svg.text([x + 36.0, y + 15.0], Font::new(TEXT - 1.0, ink), &text);
        y += 26.0;
    }
    y
}
