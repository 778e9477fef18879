//! The memory that frames are planned in, kept from one frame to the next.
//!
//! Planning asks for many short lists: which instances a light reaches, what casts before it, which volumes share a step.
//! They come out of a [`Workspace`], and go back to it as they are dropped; so one frame after the other is planned
//! without asking the system for memory, however many casters there are. It is memory, not state: what is planned does
//! not depend on it.

use std::cell::{OnceCell, RefCell};
use std::collections::HashMap;
use std::fmt;
use std::ops::{Deref, DerefMut};

use super::Caster;
use super::overflow;
use super::surfaces::Place;
use super::windows::{Footprint, Window};
use crate::frame::lists::{List, Lists};
use crate::frame::{Surface, VolumePart};
use crate::geometry::Body;
use crate::geometry::footprint::Receiver;

/// Memory for everything that planning lists.
#[derive(Default)]
pub struct Workspace {
    /// What steps draw.
    pub surfaces: Lists<Surface>,
    /// The same, of volumes.
    pub parts: Lists<VolumePart>,
    /// Surfaces on their way into such a list.
    pub found_surfaces: Spares<Surface>,
    /// Parts of volumes on theirs.
    pub found_parts: Spares<VolumePart>,
    /// Numbers of instances, nodes, casters, volumes.
    pub numbers: Spares<usize>,
    /// Answers about each instance.
    pub flags: Spares<bool>,
    /// The same, once asked for.
    pub answers: Spares<OnceCell<bool>>,
    /// Sizes of instances, metres.
    pub sizes: Spares<Option<f32>>,
    /// Their boxes.
    pub boxes: Spares<Body>,
    /// The same, as shadows fall on them.
    pub grounds: Spares<Receiver>,
    /// Volumes on their way into windows.
    pub footprints: Spares<Footprint>,
    /// Where volumes are counted.
    pub windows: Spares<Window>,
    /// Where they are before a mirror.
    pub places: Spares<Place>,
    /// Which silhouettes the device finds.
    pub decided: RefCell<Decided>,
    pub(super) overflow: RefCell<overflow::Scratch>,
    casters: Spares<Caster<'static>>,
}

impl fmt::Debug for Workspace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Workspace").finish_non_exhaustive()
    }
}

impl Workspace {
    /// The lists of plans that are gone may be used again.
    pub fn take_back(&mut self) {
        self.surfaces.take_back();
        self.parts.take_back();
    }

    /// Room for casters.
    #[must_use]
    pub fn casters(&self) -> Casters<'_> {
        Casters { list: self.casters.take(), home: &self.casters }
    }
}

/// Whether the device finds a caster's silhouette in a light, and why not: by caster and light, and whether the caster is
/// reflected and its volume has an end of its own.
pub type Decided = HashMap<(usize, usize, bool, bool), Result<(), &'static str>>;

/// Lists that nobody needs just now.
#[derive(Debug)]
pub struct Spares<T>(RefCell<Vec<Vec<T>>>);

impl<T> Default for Spares<T> {
    fn default() -> Self {
        Self(RefCell::default())
    }
}

impl<T> Spares<T> {
    /// An empty list, which comes back when it is dropped.
    #[must_use]
    pub fn lend(&self) -> Lent<'_, T> {
        Lent { list: self.take(), home: self }
    }

    /// A list of these, which comes back when it is dropped.
    pub fn collect(&self, items: impl IntoIterator<Item = T>) -> Lent<'_, T> {
        let mut list = self.lend();
        list.extend(items);
        list
    }

    fn take(&self) -> Vec<T> {
        self.0.borrow_mut().pop().unwrap_or_default()
    }

    fn give(&self, list: Vec<T>) {
        self.0.borrow_mut().push(list);
    }
}

/// A list that is lent for a while.
#[derive(Debug)]
pub struct Lent<'a, T> {
    list: Vec<T>,
    home: &'a Spares<T>,
}

impl<T> Deref for Lent<'_, T> {
    type Target = Vec<T>;

    fn deref(&self) -> &Vec<T> {
        &self.list
    }
}

impl<T> DerefMut for Lent<'_, T> {
    fn deref_mut(&mut self) -> &mut Vec<T> {
        &mut self.list
    }
}

impl<T> Drop for Lent<'_, T> {
    fn drop(&mut self) {
        self.list.clear();
        self.home.give(std::mem::take(&mut self.list));
    }
}

/// Casters before one light, in memory that is lent.
pub struct Casters<'a> {
    list: Vec<Caster<'a>>,
    home: &'a Spares<Caster<'static>>,
}

impl<'a> Deref for Casters<'a> {
    type Target = Vec<Caster<'a>>;

    fn deref(&self) -> &Vec<Caster<'a>> {
        &self.list
    }
}

impl DerefMut for Casters<'_> {
    fn deref_mut(&mut self) -> &mut Self::Target {
        &mut self.list
    }
}

impl Drop for Casters<'_> {
    fn drop(&mut self) {
        let mut list = std::mem::take(&mut self.list);
        list.clear();
        // Of another lifetime: a list is collected from one of the same layout where that one was.
        self.home.give(list.into_iter().map_while(|_| None).collect());
    }
}

/// Which instances a light may reach.
#[derive(Debug)]
pub struct Reached<'a> {
    /// Of each instance.
    pub instances: Lent<'a, bool>,
    /// Where lists are made.
    pub lists: &'a Lists<Surface>,
}

impl Reached<'_> {
    /// Those of some surfaces that it reaches; or that it does not.
    #[must_use]
    pub fn of(&self, surfaces: &List<Surface>, reached: bool) -> List<Surface> {
        let wanted = |surface: &&Surface| self.instances[surface.instance] == reached;
        let count = surfaces.iter().filter(wanted).count();
        match count {
            0 => List::default(),
            _ if count == surfaces.len() => surfaces.clone(),
            _ => self.lists.collect(surfaces.iter().filter(wanted).copied()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_lent_comes_back_empty_and_is_lent_again() {
        let spares = Spares::default();
        let at = {
            let list = spares.collect(0..50);
            let other = spares.collect([7]);
            assert_ne!(list.as_ptr(), other.as_ptr(), "both are in use");
            list.as_ptr()
        };
        let again = spares.lend();
        assert!(again.is_empty() && again.as_ptr() == at && again.capacity() >= 50);
    }

    #[test]
    fn casters_of_the_next_frame_stand_where_those_before_stood() {
        let workspace = Workspace::default();
        let at = {
            let mut casters = workspace.casters();
            casters.reserve(100);
            casters.as_ptr().addr()
        };
        let again = workspace.casters();
        assert!(again.as_ptr().addr() == at && again.capacity() >= 100);
    }
}
