//! Lists that steps share, in memory that is used again.
//!
//! A frame's steps list every surface and every part of a volume that they draw, often the same ones several times. So
//! a [`List`] is shared, never changed; and whoever plans frame after frame keeps the memory of the lists it has handed
//! out ([`Lists`]), and finds it free again when the plan that held them is gone.

use std::cell::RefCell;
use std::fmt;
use std::ops::Deref;
use std::sync::Arc;

use serde::{Serialize, Serializer};

/// A list that costs nothing to copy.
#[derive(Clone, PartialEq, Eq)]
pub struct List<T>(Arc<Vec<T>>);

impl<T> Default for List<T> {
    fn default() -> Self {
        Self(Arc::default())
    }
}

impl<T> Deref for List<T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        &self.0
    }
}

impl<T> From<Vec<T>> for List<T> {
    fn from(items: Vec<T>) -> Self {
        Self(Arc::new(items))
    }
}

impl<T> FromIterator<T> for List<T> {
    fn from_iter<I: IntoIterator<Item = T>>(items: I) -> Self {
        Vec::from_iter(items).into()
    }
}

impl<'a, T> IntoIterator for &'a List<T> {
    type Item = &'a T;
    type IntoIter = std::slice::Iter<'a, T>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl<T: fmt::Debug> fmt::Debug for List<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl<T: Serialize> Serialize for List<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.serialize(serializer)
    }
}

/// Makes [`List`]s in the memory of those that nobody holds any more.
#[derive(Debug)]
pub struct Lists<T> {
    free: RefCell<Vec<Arc<Vec<T>>>>,
    lent: RefCell<Vec<Arc<Vec<T>>>>,
}

impl<T> Default for Lists<T> {
    fn default() -> Self {
        Self { free: RefCell::default(), lent: RefCell::default() }
    }
}

impl<T> Lists<T> {
    /// A list of these.
    pub fn collect(&self, items: impl IntoIterator<Item = T>) -> List<T> {
        let free = self.free.borrow_mut().pop();
        let mut list = free.unwrap_or_default();
        match Arc::get_mut(&mut list) {
            Some(own) => {
                own.clear();
                own.extend(items);
            }
            None => list = Arc::new(Vec::from_iter(items)),
        }
        self.lent.borrow_mut().push(list.clone());
        List(list)
    }

    /// What nobody holds any more is free again.
    pub fn take_back(&mut self) {
        let (free, lent) = (self.free.get_mut(), self.lent.get_mut());
        // The last one is taken first, and a frame's lists come in the order of the frame before: they fit their memory.
        lent.reverse();
        free.extend(lent.extract_if(.., |list| Arc::strong_count(list) == 1));
        lent.reverse();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_is_used_again_when_its_list_is_gone_and_not_before() {
        let mut lists = Lists::default();
        let (first, second) = (lists.collect(0..100), lists.collect(5..7));
        let (at_first, at_second) = (first.as_ptr(), second.as_ptr());
        let copy = first.clone();
        assert_eq!((copy.as_ptr(), &first[98..]), (at_first, &[98, 99][..]), "a copy is the same list");
        drop((first, second));
        lists.take_back();
        let third = lists.collect([8]);
        assert_eq!((third.as_ptr(), &*third), (at_second, &[8][..]));
        assert_ne!(lists.collect([9]).as_ptr(), at_first, "somebody still reads it");
        assert_eq!(copy.len(), 100);
        drop(copy);
        lists.take_back();
        assert!((0..4).any(|_| lists.collect([1]).as_ptr() == at_first));
    }

    #[test]
    fn one_frame_after_the_other_stands_in_the_same_memory() {
        let mut lists = Lists::default();
        let mut frame = || {
            lists.take_back();
            let plan: Vec<_> = [40, 3, 17].map(|length| lists.collect(0..length)).into();
            plan.iter().map(|list| list.as_ptr()).collect::<Vec<_>>()
        };
        assert_eq!(frame(), frame());
    }
}
