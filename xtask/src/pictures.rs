//! Pictures of the report for the README and the docs, taken by a browser without a screen.

use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Parts of the page that are taken: the address within it, and the picture's name.
const PARTS: [(&str, &str); 4] = [
    ("frame", "report.png"),
    ("kinematics", "kinematics.png"),
    ("space", "space.png"),
    ("review", "review.png"),
];

/// Takes pictures of the report in a folder of results.
///
/// # Errors
/// There is no report or no browser, or the browser takes no picture.
pub fn pictures(results: &Path, output: &Path) -> Result<bool, Box<dyn Error>> {
    let page = results.join("report.html");
    let page = page.canonicalize().map_err(|e| format!("{}: {e}; run the study first", page.display()))?;
    let browser =
        browser().ok_or("no Chromium found: chromium, chromium-browser or google-chrome on the path")?;
    std::fs::create_dir_all(output)?;
    for (part, name) in PARTS {
        let to = output.canonicalize()?.join(name);
        let status = Command::new(&browser)
            .args(["--headless", "--no-sandbox", "--hide-scrollbars", "--window-size=1280,800"])
            .args(["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"])
            .args(["--virtual-time-budget=20000", "--no-first-run"])
            .arg(format!("--screenshot={}", to.display()))
            .arg(format!("file://{}#{part}", page.display()))
            .stderr(Stdio::null())
            .status()?;
        if !status.success() || !to.exists() {
            return Err(format!("{} took no picture of #{part}: {status}", browser.display()).into());
        }
        println!("{}", output.join(name).display());
    }
    Ok(true)
}

/// A browser on the path.
fn browser() -> Option<PathBuf> {
    let names = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];
    let folders = std::env::var_os("PATH")?;
    std::env::split_paths(&folders)
        .flat_map(|folder| names.map(|name| folder.join(name)))
        .find(|path| path.is_file())
}
