//! Why a file could not be imported: one line each, naming the file and the part at fault.

use thiserror::Error;

/// A file that is no scene, and why.
#[derive(Debug, Error)]
#[error("{file}: {problem}")]
pub struct ImportError {
    /// The path, or the name of an embedded model.
    pub file: String,
    /// What is wrong, and where in the file.
    pub problem: Problem,
}

impl ImportError {
    pub(crate) fn new(file: &str, problem: Problem) -> Self {
        Self { file: one_line(file), problem }
    }
}

/// What is wrong with a file. Texts hold no line breaks, whatever the file says.
#[derive(Debug, Error)]
pub enum Problem {
    /// The system refused.
    #[error("cannot be read: {0}")]
    Read(std::io::Error),
    /// A folder, a pipe, a device.
    #[error("cannot be read: it is {0}, not a regular file")]
    NotRegular(&'static str),
    /// Nothing in it.
    #[error("is empty")]
    Empty,
    /// Larger than we are willing to read or to unpack.
    #[error("{what} too large: the limit is {limit}")]
    TooLarge {
        /// `the file is`, `its geometry is`.
        what: &'static str,
        /// In words.
        limit: String,
    },
    /// The first bytes are neither.
    #[error("is neither a GLB nor a glTF file: it starts with neither `glTF` nor `{{`")]
    Unrecognised,
    /// The binary container is damaged.
    #[error("damaged GLB: {0}")]
    Glb(String),
    /// The JSON is damaged.
    #[error("damaged JSON: {0}")]
    Json(String),
    /// The JSON is not glTF's.
    #[error("{part}: {what}")]
    Part {
        /// `mesh 2 "Fox", primitive 0`.
        part: String,
        /// What is wrong with it.
        what: String,
    },
    /// An accessor's data is not what its user needs, or not there.
    #[error("{part}, accessor {accessor}: {error}")]
    Accessor {
        /// Who asked for it: `mesh 2 "Fox", primitive 0, POSITION`.
        part: String,
        /// Its index in the file.
        accessor: usize,
        /// What is wrong with it.
        error: AccessorError,
    },
    /// Another version of the format.
    #[error("is glTF {0}; only version 2 can be read")]
    Version(String),
    /// `extensionsRequired` holds what this program does not know.
    #[error("needs glTF extensions that this program does not have: {0}")]
    Extensions(String),
    /// There is no triangle in the scene.
    #[error("nothing to draw: {0}")]
    Nothing(String),
}

/// What is wrong with an accessor.
#[derive(Debug, Error, PartialEq, Eq)]
pub enum AccessorError {
    /// The index leads nowhere.
    #[error("does not exist; the file has {0}")]
    Missing(usize),
    /// `componentType` or `type` is not glTF's.
    #[error("its type is not one of glTF's")]
    UnknownType,
    /// A known type in the wrong place.
    #[error("is {found}; {wanted} was expected here")]
    WrongType {
        /// `VEC3 of FLOAT`.
        found: String,
        /// `SCALAR of unsigned integers`.
        wanted: &'static str,
    },
    /// The view index leads nowhere.
    #[error("buffer view {0} does not exist")]
    NoView(usize),
    /// The view's buffer index leads nowhere.
    #[error("buffer {0} does not exist")]
    NoBuffer(usize),
    /// The buffer has neither a URI nor a GLB chunk.
    #[error("buffer {0} has no data")]
    NoData(usize),
    /// The view reaches past its buffer.
    #[error("buffer view {view} ends at byte {end}, past the {length} bytes of buffer {buffer}")]
    ViewEnd {
        /// The view.
        view: usize,
        /// Where it ends; `u64::MAX` when that number does not even exist.
        end: u64,
        /// Its buffer.
        buffer: usize,
        /// The buffer's length.
        length: u64,
    },
    /// The elements reach past the view.
    #[error("its {count} elements end at byte {end}, past the {length} bytes of buffer view {view}")]
    End {
        /// How many elements.
        count: u64,
        /// Where they end; `u64::MAX` when that number does not even exist.
        end: u64,
        /// The view.
        view: usize,
        /// The view's length.
        length: u64,
    },
    /// Elements would overlap.
    #[error("the stride of {stride} bytes in buffer view {view} is smaller than an element of {element} bytes")]
    Stride {
        /// The view.
        view: usize,
        /// Its stride.
        stride: usize,
        /// The element's size.
        element: usize,
    },
    /// More elements replaced than there are.
    #[error("replaces {0} sparse elements, but has only {1}")]
    SparseCount(u64, u64),
    /// A replaced element that is not there.
    #[error("replaces sparse element {0}, but has only {1}")]
    SparseIndex(u32, u64),
    /// NaN or infinite.
    #[error("element {0} holds a number that is not finite")]
    NotFinite(usize),
    /// The unpacked data would be larger than we are willing to hold.
    #[error("its {0} elements are more than the file's memory budget allows")]
    Budget(u64),
    /// Two arrays that go together have different lengths.
    #[error("has {found} elements where {wanted} are needed")]
    Count {
        /// How many there are.
        found: usize,
        /// How many there should be.
        wanted: usize,
    },
}

/// `mesh 2 "Fox"`: how errors and warnings name a part of the file.
pub(super) fn part(kind: &str, index: usize, name: Option<&str>) -> String {
    match name {
        Some(name) if !name.is_empty() => format!("{kind} {index} {:?}", clip(name)),
        _ => format!("{kind} {index}"),
    }
}

/// A part's own name, fit for lists and titles, or `mesh 2`.
pub(super) fn name(kind: &str, index: usize, name: Option<&str>) -> String {
    match name {
        Some(name) if !name.trim().is_empty() => one_line(&clip(name)),
        _ => format!("{kind} {index}"),
    }
}

/// The first characters of a long text from a file.
pub(super) fn clip(text: &str) -> String {
    const LONGEST: usize = 60;
    if text.chars().count() <= LONGEST { text.to_owned() } else { text.chars().take(LONGEST).chain("...".chars()).collect() }
}

/// Without control characters, so that it stays on its line.
pub(super) fn one_line(text: &str) -> String {
    text.chars().flat_map(|c| if c.is_control() { c.escape_default().collect::<Vec<_>>() } else { vec![c] }).collect()
}

/// What the importer left out or replaced; a hostile file gets no endless list.
#[derive(Debug, Default)]
pub(super) struct Warnings {
    texts: Vec<String>,
    more: usize,
}

impl Warnings {
    const MOST: usize = 50;

    /// Notes one, once.
    pub fn push(&mut self, text: String) {
        if self.texts.len() >= Self::MOST {
            self.more += 1;
        } else if !self.texts.contains(&text) {
            self.texts.push(text);
        }
    }

    /// All of them, for the scene.
    pub fn finish(mut self) -> Vec<String> {
        if self.more > 0 {
            self.texts.push(format!("and {} more of this kind", self.more));
        }
        self.texts
    }
}

/// What a file may make us hold, in bytes; taken before anything is allocated.
#[derive(Debug)]
pub(super) struct Budget(std::cell::Cell<u64>);

impl Budget {
    pub fn new(bytes: u64) -> Self {
        Self(std::cell::Cell::new(bytes))
    }

    /// True when there was that much left, which there then is no more.
    #[must_use]
    pub fn take(&self, bytes: Option<u64>) -> bool {
        match bytes.and_then(|bytes| self.0.get().checked_sub(bytes)) {
            Some(left) => {
                self.0.set(left);
                true
            }
            None => false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_from_a_file_stay_on_one_line_and_short() {
        assert_eq!(part("mesh", 2, Some("a\nb")), "mesh 2 \"a\\nb\"");
        assert_eq!(part("mesh", 2, Some("")), "mesh 2");
        assert_eq!(clip(&"x".repeat(70)).len(), 63);
        assert_eq!(one_line("a\nb\u{1b}c"), "a\\nb\\u{1b}c");
    }

    #[test]
    fn a_budget_is_spent_once() {
        let budget = Budget::new(10);
        assert!(budget.take(Some(6)));
        assert!(!budget.take(Some(5)));
        assert!(!budget.take(None));
        assert!(budget.take(Some(4)));
    }

    #[test]
    fn warnings_are_told_once_and_counted_past_the_limit() {
        let mut warnings = Warnings::default();
        warnings.push("same".into());
        warnings.push("same".into());
        for index in 0..60 {
            warnings.push(index.to_string());
        }
        let texts = warnings.finish();
        assert_eq!(texts.len(), Warnings::MOST + 1);
        assert_eq!(texts[Warnings::MOST], "and 11 more of this kind");
    }
}
