//! Numbers out of buffers, every step checked.
//!
//! An accessor says: so many elements of this type, starting here in that view, so many bytes
//! apart. Nothing of that is believed: each sum is checked for overflow, the elements must end within
//! the view and the view within its buffer, an element within the stride; memory is taken from the
//! file's budget before it is allocated. An accessor without a view is zeros, and `sparse` replaces
//! some elements afterwards. Integers become floats as `normalized` says, or as they are
//! (KHR_mesh_quantization).

use std::borrow::Cow;
use std::cell::RefCell;
use std::collections::HashMap;
use std::rc::Rc;

use gltf::json::accessor::{Accessor, ComponentType, IndexComponentType, Type};
use gltf::json::validation::Checked;
use gltf::json::{Index, Root};

use super::error::{AccessorError, Budget, Problem};

/// An accessor's elements as floats.
#[derive(Debug)]
pub(super) struct Floats {
    /// Numbers an element.
    pub width: usize,
    /// `count * width` numbers.
    pub values: Vec<f32>,
}

impl Floats {
    pub fn count(&self) -> usize {
        self.values.len() / self.width.max(1)
    }

    /// One element, as an array of the right width.
    pub fn get<const N: usize>(&self, index: usize) -> Option<[f32; N]> {
        let start = index.checked_mul(self.width)?;
        self.values.get(start..start.checked_add(N)?)?.try_into().ok()
    }
}

/// The file's accessors. What is decoded is kept: meshes share vertex arrays, and a hostile file
/// cannot have the same megabytes decoded a thousand times.
pub(super) struct Store<'a> {
    root: &'a Root,
    buffers: &'a [Option<Cow<'a, [u8]>>],
    budget: &'a Budget,
    floats: RefCell<HashMap<usize, Rc<Floats>>>,
    integers: RefCell<HashMap<usize, Rc<Vec<u32>>>>,
}

/// How an accessor's elements lie in a view's bytes.
struct Layout<'a> {
    bytes: &'a [u8],
    stride: usize,
    element: usize,
}

/// A type as the accessors of one purpose may have it.
pub(super) struct Wanted {
    pub types: &'static [Type],
    /// Any component type, or floats and normalized integers only.
    pub any_component: bool,
    /// For the error message.
    pub words: &'static str,
}

/// Positions, normals, and their displacements; quantized too.
pub(super) const VEC3: Wanted = Wanted { types: &[Type::Vec3], any_component: true, words: "VEC3" };
/// Texture coordinates; quantized too.
pub(super) const VEC2: Wanted = Wanted { types: &[Type::Vec2], any_component: true, words: "VEC2" };
/// Colours.
pub(super) const COLOR: Wanted =
    Wanted { types: &[Type::Vec3, Type::Vec4], any_component: false, words: "VEC3 or VEC4 of floats or normalized integers" };
/// Joint weights, rotations.
pub(super) const VEC4: Wanted =
    Wanted { types: &[Type::Vec4], any_component: false, words: "VEC4 of floats or normalized integers" };
/// Key times, morph weights.
pub(super) const SCALAR: Wanted =
    Wanted { types: &[Type::Scalar], any_component: false, words: "SCALAR of floats or normalized integers" };
/// Bind matrices.
pub(super) const MAT4: Wanted = Wanted { types: &[Type::Mat4], any_component: false, words: "MAT4 of FLOAT" };

impl<'a> Store<'a> {
    pub fn new(root: &'a Root, buffers: &'a [Option<Cow<'a, [u8]>>], budget: &'a Budget) -> Self {
        Self { root, buffers, budget, floats: RefCell::default(), integers: RefCell::default() }
    }

    /// The budget everything of the file shares.
    pub fn budget(&self) -> &Budget {
        self.budget
    }

    /// An accessor's elements as floats, all finite. `part` says who asks.
    pub fn floats(&self, index: Index<Accessor>, wanted: &Wanted, part: impl Fn() -> String) -> Result<Rc<Floats>, Problem> {
        let floats = self.any_floats(index, wanted, &part)?;
        match floats.values.iter().position(|value| !value.is_finite()) {
            None => Ok(floats),
            Some(at) => Err(Self::error(index, AccessorError::NotFinite(at / floats.width.max(1)), part)),
        }
    }

    /// As [`Self::floats`], with NaN and infinities left in: for what can be mended.
    pub fn any_floats(&self, index: Index<Accessor>, wanted: &Wanted, part: impl Fn() -> String) -> Result<Rc<Floats>, Problem> {
        self.try_floats(index.value(), wanted).map_err(|error| Self::error(index, error, part))
    }

    /// An accessor's elements as unsigned integers of one to four components.
    pub fn integers(
        &self,
        index: Index<Accessor>,
        type_: Type,
        largest: ComponentType,
        part: impl Fn() -> String,
    ) -> Result<Rc<Vec<u32>>, Problem> {
        self.try_integers(index.value(), type_, largest).map_err(|error| Self::error(index, error, part))
    }

    /// An error of one accessor's, for who asked for it.
    pub fn error(index: Index<Accessor>, error: AccessorError, part: impl Fn() -> String) -> Problem {
        Problem::Accessor { part: part(), accessor: index.value(), error }
    }

    fn try_floats(&self, index: usize, wanted: &Wanted) -> Result<Rc<Floats>, AccessorError> {
        let accessor = self.root.accessors.get(index).ok_or(AccessorError::Missing(self.root.accessors.len()))?;
        let (component, type_) = types(accessor)?;
        let normal = component == ComponentType::F32 || accessor.normalized || wanted.any_component;
        if !wanted.types.contains(&type_) || !normal || component == ComponentType::U32 {
            return Err(AccessorError::WrongType { found: describe(component, type_), wanted: wanted.words });
        }
        if type_ == Type::Mat4 && component != ComponentType::F32 {
            return Err(AccessorError::WrongType { found: describe(component, type_), wanted: wanted.words });
        }
        if let Some(known) = self.floats.borrow().get(&index) {
            return Ok(known.clone());
        }
        let width = type_.multiplicity();
        let values = self.decode(accessor, component, width, |bytes| to_float(component, accessor.normalized, bytes))?;
        let floats = Rc::new(Floats { width, values });
        self.floats.borrow_mut().insert(index, floats.clone());
        Ok(floats)
    }

    fn try_integers(&self, index: usize, wanted: Type, largest: ComponentType) -> Result<Rc<Vec<u32>>, AccessorError> {
        let accessor = self.root.accessors.get(index).ok_or(AccessorError::Missing(self.root.accessors.len()))?;
        let (component, type_) = types(accessor)?;
        let unsigned = matches!(component, ComponentType::U8 | ComponentType::U16 | ComponentType::U32);
        if type_ != wanted || !unsigned || component.size() > largest.size() {
            let words = match (wanted, largest) {
                (Type::Scalar, _) => "SCALAR of unsigned integers",
                _ => "VEC4 of UNSIGNED_BYTE or UNSIGNED_SHORT",
            };
            return Err(AccessorError::WrongType { found: describe(component, type_), wanted: words });
        }
        if let Some(known) = self.integers.borrow().get(&index) {
            return Ok(known.clone());
        }
        let values = Rc::new(self.decode(accessor, component, type_.multiplicity(), |bytes| to_integer(component, bytes))?);
        self.integers.borrow_mut().insert(index, values.clone());
        Ok(values)
    }

    fn decode<T: Copy + Default>(
        &self,
        accessor: &Accessor,
        component: ComponentType,
        width: usize,
        convert: impl Fn(&[u8]) -> T,
    ) -> Result<Vec<T>, AccessorError> {
        let count = accessor.count.0;
        let size = component.size();
        let element = size * width;
        let over_budget = || AccessorError::Budget(count);
        let numbers = count.checked_mul(width as u64).ok_or_else(over_budget)?;
        if !self.budget.take(numbers.checked_mul(4)) {
            return Err(over_budget());
        }
        let numbers = usize::try_from(numbers).map_err(|_| over_budget())?;
        let mut values = Vec::with_capacity(numbers);
        if let Some(view) = accessor.buffer_view {
            let offset = accessor.byte_offset.map_or(0, |offset| offset.0);
            let layout = self.layout(view.value(), offset, count, element)?;
            // The last chunk may end right after its element; all others hold a whole stride.
            for bytes in layout.bytes.chunks(layout.stride).take(numbers / width.max(1)) {
                values.extend(bytes[..layout.element].chunks_exact(size).map(&convert));
            }
        }
        values.resize(numbers, T::default());
        if let Some(sparse) = &accessor.sparse {
            let replaced = sparse.count.0;
            if replaced > count {
                return Err(AccessorError::SparseCount(replaced, count));
            }
            let Checked::Valid(IndexComponentType(index_type)) = sparse.indices.component_type else {
                return Err(AccessorError::UnknownType);
            };
            let indices =
                self.layout(sparse.indices.buffer_view.value(), sparse.indices.byte_offset.0, replaced, index_type.size())?;
            let replacements = self.layout(sparse.values.buffer_view.value(), sparse.values.byte_offset.0, replaced, element)?;
            // Replaced <= count, which is a `usize`: the budget has been asked.
            let pairs = indices.bytes.chunks(indices.stride).zip(replacements.bytes.chunks(replacements.stride));
            for (index, bytes) in pairs.take(usize::try_from(replaced).map_err(|_| over_budget())?) {
                let index = to_integer(index_type, &index[..indices.element]);
                let start = index as usize * width;
                let Some(target) = values.get_mut(start..start + width) else {
                    return Err(AccessorError::SparseIndex(index, count));
                };
                for (value, bytes) in target.iter_mut().zip(bytes[..element].chunks_exact(size)) {
                    *value = convert(bytes);
                }
            }
        }
        Ok(values)
    }

    /// The bytes of `count` elements in a view, from the first to the last one's end.
    fn layout(&self, view: usize, offset: u64, count: u64, element: usize) -> Result<Layout<'_>, AccessorError> {
        let stride = self.root.buffer_views.get(view).ok_or(AccessorError::NoView(view))?.byte_stride;
        let bytes = self.view(view)?;
        let stride = stride.map(|stride| stride.0).filter(|stride| *stride != 0).unwrap_or(element);
        if stride < element {
            return Err(AccessorError::Stride { view, stride, element });
        }
        if count == 0 {
            return Ok(Layout { bytes: &[], stride, element });
        }
        let end = (count - 1).checked_mul(stride as u64).and_then(|end| end.checked_add(offset)?.checked_add(element as u64));
        let past = AccessorError::End { count, end: end.unwrap_or(u64::MAX), view, length: bytes.len() as u64 };
        let range = end.and_then(|end| Some(usize::try_from(offset).ok()?..usize::try_from(end).ok()?));
        let bytes = range.and_then(|range| bytes.get(range)).ok_or(past)?;
        Ok(Layout { bytes, stride, element })
    }

    /// A view's bytes.
    pub fn view(&self, index: usize) -> Result<&[u8], AccessorError> {
        let view = self.root.buffer_views.get(index).ok_or(AccessorError::NoView(index))?;
        let buffer = view.buffer.value();
        let bytes = self.buffers.get(buffer).ok_or(AccessorError::NoBuffer(buffer))?;
        let bytes = bytes.as_deref().ok_or(AccessorError::NoData(buffer))?;
        let start = view.byte_offset.map_or(0, |offset| offset.0);
        let end = start.checked_add(view.byte_length.0);
        let range = end.and_then(|end| Some(usize::try_from(start).ok()?..usize::try_from(end).ok()?));
        range.and_then(|range| bytes.get(range)).ok_or(AccessorError::ViewEnd {
            view: index,
            end: end.unwrap_or(u64::MAX),
            buffer,
            length: bytes.len() as u64,
        })
    }
}

fn types(accessor: &Accessor) -> Result<(ComponentType, Type), AccessorError> {
    match (&accessor.component_type, &accessor.type_) {
        (Checked::Valid(component), Checked::Valid(type_)) => Ok((component.0, *type_)),
        _ => Err(AccessorError::UnknownType),
    }
}

fn describe(component: ComponentType, type_: Type) -> String {
    let type_ = match type_ {
        Type::Scalar => "SCALAR",
        Type::Vec2 => "VEC2",
        Type::Vec3 => "VEC3",
        Type::Vec4 => "VEC4",
        Type::Mat2 => "MAT2",
        Type::Mat3 => "MAT3",
        Type::Mat4 => "MAT4",
    };
    let component = match component {
        ComponentType::I8 => "BYTE",
        ComponentType::U8 => "UNSIGNED_BYTE",
        ComponentType::I16 => "SHORT",
        ComponentType::U16 => "UNSIGNED_SHORT",
        ComponentType::U32 => "UNSIGNED_INT",
        ComponentType::F32 => "FLOAT",
    };
    format!("{type_} of {component}")
}

/// One component; `bytes` has its size.
fn to_float(component: ComponentType, normalized: bool, bytes: &[u8]) -> f32 {
    let (value, most) = match (component, bytes) {
        (ComponentType::I8, &[a]) => (f32::from(i8::from_le_bytes([a])), 127.0),
        (ComponentType::U8, &[a]) => (f32::from(a), 255.0),
        (ComponentType::I16, &[a, b]) => (f32::from(i16::from_le_bytes([a, b])), 32767.0),
        (ComponentType::U16, &[a, b]) => (f32::from(u16::from_le_bytes([a, b])), 65535.0),
        (ComponentType::F32, &[a, b, c, d]) => return f32::from_le_bytes([a, b, c, d]),
        _ => (0.0, 1.0), // UNSIGNED_INT, which no floats are made from
    };
    if normalized { (value / most).max(-1.0) } else { value }
}

/// One component; `bytes` has its size.
fn to_integer(component: ComponentType, bytes: &[u8]) -> u32 {
    match (component, bytes) {
        (ComponentType::U8, &[a]) => u32::from(a),
        (ComponentType::U16, &[a, b]) => u32::from(u16::from_le_bytes([a, b])),
        (ComponentType::U32, &[a, b, c, d]) => u32::from_le_bytes([a, b, c, d]),
        _ => 0, // signed and float types, which no integers are made from
    }
}
