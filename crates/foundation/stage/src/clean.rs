//! What the store takes up, and freeing it.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use crate::store::link;
use crate::{Key, Store, StoreError};

/// Which entries to remove.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Clean {
    /// Those that no `steps/<step>/<item>` leads to: results of earlier parameters, inputs and code.
    Unreferenced,
    /// All of them, and the links.
    Everything,
}

/// A number of entries, and what their files take up.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Size {
    /// Entries.
    pub entries: usize,
    /// Bytes of their files.
    pub bytes: u64,
}

impl Store {
    /// All entries.
    ///
    /// # Errors
    /// [`StoreError::Io`].
    pub fn size(&self) -> Result<Size, StoreError> {
        Ok(total(self.entry_dirs()?.iter().map(|(_, bytes)| *bytes)))
    }

    /// Removes entries, and says how many; with `dry_run` only says. Entries of a run that is under way are safe from
    /// [`Clean::Unreferenced`].
    ///
    /// # Errors
    /// [`StoreError::Io`].
    pub fn clean(&self, which: Clean, dry_run: bool) -> Result<Size, StoreError> {
        // Entries are listed before links, and a run links before it publishes: so no new entry is taken for an unused one.
        let mut doomed = self.entry_dirs()?;
        if which == Clean::Unreferenced {
            let mut used = BTreeSet::new();
            self.linked_below(&self.steps(), &mut used)?;
            doomed.retain(|(key, _)| !used.contains(key));
        }
        if !dry_run {
            if which == Clean::Everything {
                let steps = self.steps();
                fs::remove_dir_all(&steps).map_err(StoreError::io("remove", &steps))?;
                fs::create_dir_all(&steps).map_err(StoreError::io("make the folder", &steps))?;
            }
            for (key, _) in &doomed {
                self.discard(*key)?;
            }
            self.remove_left_overs()?;
        }
        Ok(total(doomed.iter().map(|(_, bytes)| *bytes)))
    }

    /// Every entry with the bytes of its files. What has no key for a name is not an entry, and is left alone.
    fn entry_dirs(&self) -> Result<Vec<(Key, u64)>, StoreError> {
        let mut found = Vec::new();
        for group in list(&self.entries())? {
            if !group.is_dir() {
                continue;
            }
            for dir in list(&group)? {
                let Some(key) = dir.file_name().and_then(|n| n.to_str()).and_then(Key::from_hex) else {
                    continue;
                };
                if self.entry_dir(key) == dir {
                    found.push((
                        key,
                        list(&dir)?.iter().filter_map(|f| fs::metadata(f).ok()).map(|m| m.len()).sum(),
                    ));
                }
            }
        }
        Ok(found)
    }

    fn linked_below(&self, dir: &Path, used: &mut BTreeSet<Key>) -> Result<(), StoreError> {
        for path in list(dir)? {
            if link::read(&path).is_some() {
                used.extend(self.linked(&path));
            } else if path.is_dir() {
                self.linked_below(&path, used)?;
            }
        }
        Ok(())
    }
}

fn total(sizes: impl Iterator<Item = u64>) -> Size {
    sizes.fold(Size::default(), |sum, bytes| Size { entries: sum.entries + 1, bytes: sum.bytes + bytes })
}

/// Paths in a folder. One that has just gone is empty: another run may be cleaning.
fn list(dir: &Path) -> Result<Vec<std::path::PathBuf>, StoreError> {
    match fs::read_dir(dir) {
        Ok(entries) => Ok(entries.flatten().map(|e| e.path()).collect()),
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => Ok(Vec::new()),
        Err(e) => Err(StoreError::io("list", dir)(e)),
    }
}
