//! OpenSim's tables over time, `.mot` and `.sto`: a header that ends with `endheader`, tab-separated labels, rows; `nan` where a value is missing.

use super::{PosesError, decimal, numbers, short};

/// A table over time.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Table {
    /// Its name.
    pub name: String,
    /// Whether angles are in degrees.
    pub in_degrees: bool,
    /// Labels of the columns, without the first, `time`.
    pub labels: Vec<String>,
    /// Time, s, and one value a label; none where it is missing.
    pub rows: Vec<(f64, Vec<Option<f64>>)>,
}

/// The text of a file; `notes` go into the header, a line each.
pub fn write(table: &Table, notes: &[String]) -> String {
    let mut text = format!(
        "{}\nversion=1\nnRows={}\nnColumns={}\ninDegrees={}\n",
        table.name,
        table.rows.len(),
        table.labels.len() + 1,
        if table.in_degrees { "yes" } else { "no" }
    );
    for note in notes {
        text += &format!("{note}\n");
    }
    text += "endheader\ntime";
    for label in &table.labels {
        text += &format!("\t{label}");
    }
    text.push('\n');
    for (time, values) in &table.rows {
        text += &decimal(*time, 6);
        for value in values {
            text += &value.map_or("\tnan".to_owned(), |v| format!("\t{}", decimal(v, 8)));
        }
        text.push('\n');
    }
    text
}

/// The table of a file.
///
/// # Errors
/// It has no header's end, no column `time`, or a row that does not fit its labels.
pub fn read(path: &str, text: &str) -> Result<Table, PosesError> {
    let file = |what: String| PosesError::File { path: path.to_owned(), what };
    let mut lines = text.lines().enumerate();
    let mut table = Table::default();
    let mut ended = false;
    for (number, line) in lines.by_ref() {
        let line = line.trim();
        if line.eq_ignore_ascii_case("endheader") {
            ended = true;
            break;
        }
        match line.split_once('=') {
            Some((key, value)) if key.trim().eq_ignore_ascii_case("inDegrees") => {
                table.in_degrees = value.trim().eq_ignore_ascii_case("yes");
            }
            _ if number == 0 => table.name = line.to_owned(),
            _ => {}
        }
    }
    if !ended {
        return Err(file("has no line `endheader`: not a table of OpenSim".to_owned()));
    }
    let header = lines.by_ref().find(|(_, line)| !line.trim().is_empty());
    let labels: Vec<String> =
        header.iter().flat_map(|(_, line)| line.split_whitespace()).map(str::to_owned).collect();
    match labels.split_first() {
        Some((first, labels)) if first.eq_ignore_ascii_case("time") => table.labels = labels.to_vec(),
        first => {
            let found = first.map_or("nothing", |(first, _)| first);
            return Err(file(format!("the first column is `{}`, expected `time`", short(found))));
        }
    }
    for (number, line) in lines.filter(|(_, line)| !line.trim().is_empty()) {
        let fail = |what: String| PosesError::Line { path: path.to_owned(), line: number + 1, what };
        let values = numbers(line).map_err(fail)?;
        let (time, values) = match values.split_first() {
            Some((time, values)) if values.len() == table.labels.len() && time.is_finite() => (*time, values),
            _ => {
                let what = format!("{} values, expected a time and {}", values.len(), table.labels.len());
                return Err(fail(what));
            }
        };
        table.rows.push((time, values.iter().map(|v| Some(*v).filter(|v| v.is_finite())).collect()));
    }
    Ok(table)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::poses::tests::damage;

    fn table() -> Table {
        Table {
            name: "knee".to_owned(),
            in_degrees: true,
            labels: vec!["flexion".to_owned(), "lateral".to_owned()],
            rows: vec![(0.0, vec![Some(12.5), None]), (0.01, vec![Some(-0.25), Some(3.0)])],
        }
    }

    #[test]
    fn what_is_written_comes_back() {
        let text = write(&table(), &["angles in degrees, translations in mm".to_owned()]);
        assert_eq!(read("x.mot", &text), Ok(table()));
        assert!(text.starts_with("knee\nversion=1\nnRows=2\nnColumns=3\ninDegrees=yes\n"), "{text}");
        assert!(text.contains("endheader\ntime\tflexion\tlateral\n0.000000\t12.50000000\tnan\n"), "{text}");
    }

    #[test]
    fn faults_name_file_and_line_and_no_damage_makes_the_reader_panic() {
        let text = write(&table(), &[]);
        let error = read("x.mot", &text.replace("\tnan", "")).unwrap_err().to_string();
        assert_eq!(error, "x.mot:8: 2 values, expected a time and 2");
        assert!(read("x.mot", "a\nb\n").unwrap_err().to_string().contains("endheader"));
        damage(&text, |text| drop(read("x.mot", text)));
    }
}
