//! Landmarks in every form, and each fault of them with its line.

#![allow(clippy::unwrap_used)] // the helpers of tests are tests

use biplane_acquisition::inspect::describe;
use biplane_acquisition::landmarks::read_landmarks;
use biplane_artifact::Landmark;
use tempfile::TempDir;

fn read(text: &str) -> Result<Vec<(String, [f64; 3])>, String> {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("marks");
    std::fs::write(&path, text).unwrap();
    let landmarks = read_landmarks(&path).map_err(|e| {
        let text = e.to_string();
        text.rsplit('/').next().unwrap().to_owned()
    })?;
    Ok(landmarks.0.into_iter().map(|Landmark { name, at_mm }| (name, at_mm)).collect())
}

fn named(list: &[(&str, [f64; 3])]) -> Result<Vec<(String, [f64; 3])>, String> {
    Ok(list.iter().map(|(name, at)| ((*name).to_owned(), *at)).collect())
}

const FCSV: &str = "# Markups fiducial file version = 4.11
# CoordinateSystem = LPS
# columns = id,x,y,z,ow,ox,oy,oz,vis,sel,lock,label,desc,associatedNodeID
1,-12.5,3,40.25,0,0,0,1,1,1,0,medial epicondyle,,
2,30,-2,41,0,0,0,1,1,1,0,\"lateral, epicondyle\",\"on, the ridge\",vtkMRMLScalarVolumeNode1
";

const MARKUPS: &str = r#"{
    "@schema": "https://raw.githubusercontent.com/slicer/slicer/master/Modules/Loadable/Markups/Resources/Schema/markups-schema-v1.0.3.json#",
    "markups": [
        {
            "type": "Fiducial",
            "coordinateSystem": "LPS",
            "coordinateUnits": "mm",
            "controlPoints": [
                {
                    "id": "1",
                    "label": "hip",
                    "position": [-12.5, 3.0, 40.25],
                    "positionStatus": "defined"
                },
                {
                    "id": "2",
                    "label": "knee",
                    "position": [0.0, -2, 41.0],
                    "positionStatus": "defined"
                }
            ]
        }
    ]
}
"#;

#[test]
fn a_table_is_read_by_its_columns() {
    let text = "\u{feff}# by hand\n\nz_mm, note ,landmark,x_mm,y_mm\n3,left,  hip ,1,2\n# more\n-3e1,,\"knee centre\",-1,-2\n";
    let expected = [("hip", [1.0, 2.0, 3.0]), ("knee centre", [-1.0, -2.0, -30.0])];
    assert_eq!(read(text), named(&expected));
    assert_eq!(read(&text.replace('\n', "\r\n")), named(&expected));
    assert_eq!(read("landmark,x_cm,y_cm,z_cm\na,1,2,3\n"), named(&[("a", [10.0, 20.0, 30.0])]));
}

#[test]
fn four_bare_rows_are_an_origin_and_three_points() {
    let expected = named(&[
        ("origin", [1.0, 2.0, 3.0]),
        ("x", [2.0, 2.0, 3.0]),
        ("y", [1.0, 3.0, 3.0]),
        ("z", [1.0, 2.0, 4.5]),
    ]);
    assert_eq!(read("1,2,3\n2,2,3\n1,3,3\n1,2,4.5\n"), expected);
    assert_eq!(read("# axes\n1 2 3\n2\t2 3\n\n1; 3; 3\n  1, 2, 4.5"), expected);
    for wrong in
        ["1,2,3\n2,2,3\n1,3,3\n", "1,2,3\n2,2,3\n1,3,3\n1,2,4\n5,5,5\n", "1,2,3\n2,2,3\n1,3\n1,2,4\n"]
    {
        let error = read(wrong).unwrap_err();
        assert!(
            error.starts_with(
                "marks, line 1: expected a header `landmark,x_mm,y_mm,z_mm`, four rows of three numbers"
            ),
            "{error}"
        );
    }
}

#[test]
fn slicers_table_is_read_and_turned_to_lps() {
    let lps =
        named(&[("medial epicondyle", [-12.5, 3.0, 40.25]), ("lateral, epicondyle", [30.0, -2.0, 41.0])]);
    assert_eq!(read(FCSV), lps);
    assert_eq!(read(&FCSV.replace("= LPS", "= 1")), lps);
    let ras =
        named(&[("medial epicondyle", [12.5, -3.0, 40.25]), ("lateral, epicondyle", [-30.0, 2.0, 41.0])]);
    assert_eq!(read(&FCSV.replace("= LPS", "= RAS")), ras);
    assert_eq!(read(&FCSV.replace("= LPS", "= 0")), ras);
    let without = FCSV.replace("# CoordinateSystem = LPS\n", "");
    let error = read(&without).unwrap_err();
    assert!(
        error
            .starts_with("marks does not say which way its axes go; add the line `# CoordinateSystem = LPS`"),
        "{error}"
    );
    assert_eq!(
        read(&FCSV.replace("= LPS", "= LAS")).unwrap_err(),
        "marks, line 2: expected the coordinate system LPS or RAS (1 or 0), found `LAS`"
    );
    assert_eq!(
        read(&FCSV.replace("40.25", "forty")).unwrap_err(),
        "marks, line 4: expected a finite number in column `z`, found `forty`"
    );
    assert_eq!(
        read(&FCSV.replace("lateral, epicondyle", " Medial epicondyle")).unwrap_err(),
        "marks, line 5: expected each landmark once, found `Medial epicondyle` again"
    );
    let error = read(&FCSV.replace("label", "name")).unwrap_err();
    assert!(
        error.starts_with("marks, line 3: expected the columns x, y, z and label, among them `label`"),
        "{error}"
    );
}

#[test]
fn slicers_markups_are_read_and_turned_to_lps() {
    assert_eq!(read(MARKUPS), named(&[("hip", [-12.5, 3.0, 40.25]), ("knee", [0.0, -2.0, 41.0])]));
    let turned = read(&MARKUPS.replace("\"LPS\"", "\"RAS\"")).unwrap();
    assert_eq!(turned[0].1, [12.5, -3.0, 40.25]);
    assert!(turned[1].1[0].is_sign_positive(), "no negative zero");
    assert_eq!(
        read(&MARKUPS.replace("knee", " HIP ")).unwrap_err(),
        "marks, line 18: expected each landmark once, found `HIP` again"
    );
    assert_eq!(
        read(&MARKUPS.replace("-2, 41.0", "null, 41.0")).unwrap_err(),
        "marks, line 18: expected a position of three numbers of `knee`, found [0.0,null,41.0]"
    );
    assert_eq!(
        read(&MARKUPS.replacen("\"defined\"", "\"undefined\"", 1)).unwrap_err(),
        "marks, line 12: expected landmarks that are placed, found `hip`, which is undefined; place it, or delete it"
    );
    assert_eq!(
        read(&MARKUPS.replace("\"mm\"", "\"um\"")).unwrap_err(),
        "marks, line 8: expected coordinateUnits mm, found `um`"
    );
    let error =
        read(&MARKUPS.replace("],\n                    \"positionStatus\"", "]\n \"positionStatus\""))
            .unwrap_err();
    assert!(error.contains("line 13: expected JSON as 3D Slicer writes it"), "{error}");
    let none =
        MARKUPS.split("\"controlPoints\": [").next().unwrap().to_owned() + "\"controlPoints\": [] } ] }";
    assert_eq!(
        read(&none).unwrap_err(),
        "marks holds no landmark; expected a row a landmark, or delete the file"
    );
}

#[test]
fn faults_of_a_table_are_named_with_their_line() {
    let head = "# femur\nlandmark,x_mm,y_mm,z_mm\n";
    for (rows, expected) in [
        ("a,1,2,3\nb,1,2,3\n A ,4,5,6\n", "marks, line 5: expected each landmark once, found `A` again"),
        ("a,1,2,3\nb,1,x,3\n", "marks, line 4: expected a finite number in column `y_mm`, found `x`"),
        ("a,1,2\n", "marks, line 3: expected a finite number in column `z_mm`, found nothing"),
        ("a,1,2,NaN\n", "marks, line 3: expected a finite number in column `z_mm`, found `NaN`"),
        (" ,1,2,3\n", "marks, line 3: expected the landmark's name, found nothing"),
        ("", "marks holds no landmark; expected a row a landmark, or delete the file"),
    ] {
        assert_eq!(read(&format!("{head}{rows}")).unwrap_err(), expected);
    }
    assert_eq!(
        read("landmark,x_mm,y_mm\na,1,2\n").unwrap_err(),
        "marks, line 1: expected a header with the column `z_mm` (or `z_cm`, `z_m`, `z_in`), found `landmark,x_mm,y_mm`"
    );
    for empty in ["", "\n \n"] {
        assert_eq!(
            read(empty).unwrap_err(),
            "marks holds no landmark; expected a row a landmark, or delete the file"
        );
    }
    let error = read("name,x_mm,y_mm,z_mm\na,1,2,3\n").unwrap_err();
    assert!(error.starts_with("marks, line 1: expected a header `landmark,x_mm,y_mm,z_mm`"), "{error}");
    let folder = TempDir::new().unwrap();
    let error = read_landmarks(folder.path().join("gone.csv")).unwrap_err().to_string();
    assert!(error.starts_with("cannot read") && error.contains("gone.csv"), "{error}");
    std::fs::write(folder.path().join("bytes"), [0xff, 0xfe, 0x00]).unwrap();
    let error = read_landmarks(folder.path().join("bytes")).unwrap_err().to_string();
    assert!(error.contains("is not text"), "{error}");
}

#[test]
fn they_are_described() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("femur.fcsv");
    std::fs::write(&path, FCSV.replace("= LPS", "= RAS")).unwrap();
    let text = describe(&path).unwrap().to_string();
    for part in [
        "landmarks, 3D Slicer's .fcsv",
        "medial epicondyle    (12.500, -3.000, 40.250) mm",
        "left-posterior-superior; the file has right-anterior-superior, so x and y changed their sign",
    ] {
        assert!(text.contains(part), "{part} not in: {text}");
    }
    std::fs::write(&path, "landmark,x_mm,y_mm,z_mm\na,1,2,3\n").unwrap();
    let text = describe(&path).unwrap().to_string();
    assert!(text.starts_with("landmarks, CSV\n") && text.contains("that of the model"), "{text}");
}
