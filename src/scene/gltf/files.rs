//! The files that a glTF file is made of: only regular ones, only below its own folder, only so many
//! bytes.

use std::fs::File;
use std::io::Read as _;
use std::path::{Path, PathBuf};

use super::container::data_uri;
use super::error::{Budget, Problem, clip, one_line};

/// The largest file that is read, bytes.
pub(super) const LARGEST_FILE: u64 = 512 << 20;

/// Where a file's URIs lead.
pub(super) struct Folder {
    /// Canonical; `None` for a model in memory, which has no files beside it.
    root: Option<PathBuf>,
    /// Bytes that may still be read: one large file named by a thousand buffers is read once.
    budget: Budget,
}

impl Folder {
    /// Of the file at `path`: symbolic links to the file itself are the user's choice and followed.
    pub fn of(path: &Path) -> Result<Self, Problem> {
        let path = path.canonicalize().map_err(Problem::Read)?;
        Ok(Self { root: path.parent().map(Path::to_owned), budget: Budget::new(2 * LARGEST_FILE) })
    }

    /// Of a model in memory.
    pub fn nowhere() -> Self {
        Self { root: None, budget: Budget::new(2 * LARGEST_FILE) }
    }

    /// What a URI stands for, or what is wrong with it.
    pub fn resolve(&self, uri: &str) -> Result<Vec<u8>, String> {
        if uri.get(..5).is_some_and(|scheme| scheme.eq_ignore_ascii_case("data:")) {
            if !self.budget.take(Some(uri.len() as u64)) {
                return Err("holds more data than is read of one file".into());
            }
            return data_uri(uri);
        }
        let shown = one_line(&clip(uri));
        if has_scheme(uri) {
            return Err(format!("its URI `{shown}` is not a file beside this one: only relative paths and data: are read"));
        }
        let Some(root) = &self.root else {
            return Err(format!("its URI `{shown}` needs a file, but this model is in memory"));
        };
        let decoded = percent_encoding::percent_decode_str(uri).decode_utf8();
        let decoded = decoded.map_err(|_| format!("its URI `{shown}` is not UTF-8 once decoded"))?;
        let below = inside(&decoded).ok_or_else(|| format!("its URI `{shown}` leads out of the file's folder"))?;
        let mut path = root.join(below);
        if !path.exists()
            && let Some(literal) = inside(uri).map(|literal| root.join(literal)).filter(|literal| literal.exists())
        {
            path = literal; // some writers do not escape
        }
        let path = path.canonicalize().map_err(|error| format!("its file `{shown}` cannot be read: {error}"))?;
        if !path.starts_with(root) {
            return Err(format!("its file `{shown}` is a link out of the file's folder"));
        }
        read(&path, &self.budget).map_err(|problem| format!("its file `{shown}` {problem}"))
    }
}

/// `http:`, `file:`, and `C:` too.
fn has_scheme(uri: &str) -> bool {
    let scheme = uri.split(':').next().filter(|scheme| scheme.len() < uri.len());
    scheme.is_some_and(|scheme| {
        scheme.starts_with(|c: char| c.is_ascii_alphabetic())
            && scheme.chars().all(|c| c.is_ascii_alphanumeric() || "+-.".contains(c))
    })
}

/// The relative path without `.` and `..`; `None` when it is absolute or climbs out.
fn inside(uri: &str) -> Option<PathBuf> {
    if uri.starts_with(['/', '\\']) || uri.contains('\0') || has_scheme(uri) {
        return None;
    }
    let mut path = PathBuf::new();
    for piece in uri.split(['/', '\\']) {
        match piece {
            "" | "." => {}
            ".." => {
                if !path.pop() {
                    return None;
                }
            }
            name => path.push(name),
        }
    }
    (!path.as_os_str().is_empty()).then_some(path)
}

/// The bytes of a regular file, within the budget and [`LARGEST_FILE`].
pub(super) fn read(path: &Path, budget: &Budget) -> Result<Vec<u8>, Problem> {
    // Asked before opening: opening a pipe waits for its writer.
    regular(&std::fs::metadata(path).map_err(Problem::Read)?)?;
    let file = File::open(path).map_err(Problem::Read)?;
    let metadata = file.metadata().map_err(Problem::Read)?;
    regular(&metadata)?;
    let too_large = || Problem::TooLarge { what: "the file is", limit: format!("{} MiB", LARGEST_FILE >> 20) };
    if metadata.len() > LARGEST_FILE || !budget.take(Some(metadata.len())) {
        return Err(too_large());
    }
    let mut bytes = Vec::new();
    // It may grow while it is read.
    file.take(LARGEST_FILE + 1).read_to_end(&mut bytes).map_err(Problem::Read)?;
    if bytes.len() as u64 > LARGEST_FILE { Err(too_large()) } else { Ok(bytes) }
}

fn regular(metadata: &std::fs::Metadata) -> Result<(), Problem> {
    if metadata.is_file() {
        Ok(())
    } else if metadata.is_dir() {
        Err(Problem::NotRegular("a folder"))
    } else {
        Err(Problem::NotRegular("a pipe, a socket or a device"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_paths_below_the_folder() {
        for uri in ["/etc/passwd", "../x", "a/../../x", "\\x", "..\\x", "C:x", "file:x", "", ".", "a\0b", "a/.."] {
            assert_eq!(inside(uri), None, "{uri:?}");
        }
        assert_eq!(inside("a/./b/../c.bin"), Some(PathBuf::from("a/c.bin")));
        assert_eq!(inside("textures\\wood.png"), Some(PathBuf::from("textures/wood.png")), "as some writers on Windows do");
    }

    #[test]
    fn schemes() {
        for uri in ["http://x/y", "file:///x", "C:\\x", "a.b+c-d:x"] {
            assert!(has_scheme(uri), "{uri}");
        }
        for uri in ["a/b:c", "x", "1:x", ":x"] {
            assert!(!has_scheme(uri), "{uri}");
        }
    }
}
