//! Accessors: the numbers in buffers, read where they lie (glTF 2.0, section 3.6.2).

use super::Refused;
use super::buffers::Document;
use super::json::{self, Form};

/// Elements that an accessor may have of which the file has no bytes.
const MOST_WITHOUT_BYTES: u64 = 1 << 20;

/// How a number is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Component {
    fn of(code: u32) -> Result<Self, Refused> {
        match code {
            5120 => Ok(Component::I8),
            5121 => Ok(Component::U8),
            5122 => Ok(Component::I16),
            5123 => Ok(Component::U16),
            5125 => Ok(Component::U32),
            5126 => Ok(Component::F32),
            _ => Err(Refused(format!("its componentType {code} is none: expected 5120 to 5123, 5125 or 5126"))),
        }
    }

    fn size(self) -> usize {
        match self {
            Component::I8 | Component::U8 => 1,
            Component::I16 | Component::U16 => 2,
            Component::U32 | Component::F32 => 4,
        }
    }

    /// The number that begins at a place; 0 beyond the end.
    fn number(self, bytes: &[u8], at: usize, normalized: bool) -> f32 {
        let (value, most) = match self {
            Component::I8 => (f32::from(array::<1>(bytes, at)[0] as i8), 127.0),
            Component::U8 => (f32::from(array::<1>(bytes, at)[0]), 255.0),
            Component::I16 => (f32::from(i16::from_le_bytes(array(bytes, at))), 32767.0),
            Component::U16 => (f32::from(u16::from_le_bytes(array(bytes, at))), 65535.0),
            Component::U32 => return u32::from_le_bytes(array(bytes, at)) as f32,
            Component::F32 => return f32::from_le_bytes(array(bytes, at)),
        };
        if normalized { (value / most).max(-1.0) } else { value }
    }

    fn whole(self, bytes: &[u8], at: usize) -> u32 {
        match self {
            Component::I8 | Component::U8 => u32::from(array::<1>(bytes, at)[0]),
            Component::I16 | Component::U16 => u32::from(u16::from_le_bytes(array(bytes, at))),
            Component::U32 | Component::F32 => u32::from_le_bytes(array(bytes, at)),
        }
    }
}

fn array<const N: usize>(bytes: &[u8], at: usize) -> [u8; N] {
    bytes.get(at..).and_then(|rest| rest.first_chunk()).copied().unwrap_or([0; N])
}

/// Elements that lie one after the other, `stride` bytes apart.
struct Strided<'a> {
    bytes: &'a [u8],
    stride: usize,
}

/// What is said otherwise of a few elements.
struct Sparse<'a> {
    /// Which elements are replaced, in ascending order.
    indices: Vec<u32>,
    values: Strided<'a>,
}

/// The elements of an accessor.
pub struct Elements<'a> {
    pub count: usize,
    component: Component,
    normalized: bool,
    /// Zeros if there are none.
    base: Option<Strided<'a>>,
    sparse: Option<Sparse<'a>>,
}

impl<'a> Elements<'a> {
    /// Of the accessor at `index`, whose elements are of this form, and components among `allowed`.
    pub fn new(document: &'a Document, index: u32, form: Form, allowed: &[Component]) -> Result<Self, Refused> {
        let Some(accessor) = document.root.accessors.get(index as usize) else {
            return Err(Refused(format!("accessor {index} is named, but there are {}", document.root.accessors.len())));
        };
        let elements = Elements::of(document, accessor, form, allowed);
        elements.map_err(|Refused(why)| Refused(format!("accessor {index}: {why}")))
    }

    fn of(
        document: &'a Document,
        accessor: &json::Accessor,
        form: Form,
        allowed: &[Component],
    ) -> Result<Self, Refused> {
        let component = Component::of(accessor.component_type)?;
        if accessor.form != form || !allowed.contains(&component) {
            let found = format!("{:?} of {component:?}", accessor.form);
            return Err(Refused(format!("it is {found}: expected {form:?} of {allowed:?}")));
        }
        let size = width(form) * component.size();
        let strided = |view, offset| Strided::new(document, view, offset, accessor.count, size, component.size());
        let base = accessor.buffer_view.map(|view| strided(view, accessor.byte_offset)).transpose()?;
        if base.is_none() && accessor.count > MOST_WITHOUT_BYTES {
            let count = accessor.count;
            return Err(Refused(format!("it has {count} elements and no bufferView: at most {MOST_WITHOUT_BYTES}")));
        }
        let sparse = |sparse: &json::Sparse| Sparse::new(document, sparse, accessor.count, size, component.size());
        Ok(Elements {
            count: accessor.count as usize,
            component,
            normalized: accessor.normalized,
            base,
            sparse: accessor.sparse.as_ref().map(sparse).transpose()?,
        })
    }

    /// The numbers of an element, which has at least so many.
    pub fn at<const N: usize>(&self, index: usize) -> [f32; N] {
        let (bytes, first) = self.place(index);
        std::array::from_fn(|i| self.component.number(bytes, first + i * self.component.size(), self.normalized))
    }

    /// An element of one whole number.
    pub fn whole(&self, index: usize) -> u32 {
        let (bytes, first) = self.place(index);
        self.component.whole(bytes, first)
    }

    fn place(&self, index: usize) -> (&[u8], usize) {
        if let Some(sparse) = &self.sparse
            && let Ok(place) = sparse.indices.binary_search(&(index as u32))
        {
            return (sparse.values.bytes, place * sparse.values.stride);
        }
        self.base.as_ref().map_or((&[], 0), |base| (base.bytes, index * base.stride))
    }
}

fn width(form: Form) -> usize {
    match form {
        Form::Scalar => 1,
        Form::Vec2 => 2,
        Form::Vec3 => 3,
        Form::Vec4 | Form::Mat2 => 4,
        Form::Mat3 => 9,
        Form::Mat4 => 16,
    }
}

impl<'a> Strided<'a> {
    /// `count` elements of `size` bytes each, which begin at multiples of `align` in their buffer.
    fn new(
        document: &'a Document,
        view: u32,
        offset: u64,
        count: u64,
        size: usize,
        align: usize,
    ) -> Result<Self, Refused> {
        let found = document.view(view)?;
        let stride = found.stride.unwrap_or(size as u64);
        if stride < size as u64 || stride > 252 || !stride.is_multiple_of(align as u64) {
            let line = format!("expected a multiple of {align} from {size} to 252");
            return Err(Refused(format!("the byteStride of bufferView {view} is {stride}: {line}")));
        }
        let begin = u128::from(found.offset) + u128::from(offset);
        if !begin.is_multiple_of(align as u128) {
            return Err(Refused(format!("it begins at byte {begin}, which is no multiple of {align}")));
        }
        let end = match count {
            0 => u128::from(offset),
            _ => u128::from(offset) + u128::from(stride) * u128::from(count - 1) + size as u128,
        };
        if end > found.bytes.len() as u128 {
            let length = found.bytes.len();
            let line = format!("its {count} elements end at byte {end} of bufferView {view}, which has {length}");
            return Err(Refused(line));
        }
        Ok(Strided { bytes: &found.bytes[offset as usize..], stride: stride as usize })
    }
}

impl<'a> Sparse<'a> {
    fn new(
        document: &'a Document,
        sparse: &json::Sparse,
        count: u64,
        size: usize,
        align: usize,
    ) -> Result<Self, Refused> {
        let json::Sparse { count: few, indices, values } = sparse;
        let component = Component::of(indices.component_type)?;
        if !INDICES.contains(&component) {
            return Err(Refused(format!("its sparse indices are {component:?}: expected one of {INDICES:?}")));
        }
        let place = |view, offset, size, align| Strided::new(document, view, offset, *few, size, align);
        let found = place(indices.buffer_view, indices.byte_offset, component.size(), component.size())?;
        document.count_sparse(*few)?;
        let values = place(values.buffer_view, values.byte_offset, size, align)?;
        let indices: Vec<u32> = (0..*few as usize).map(|i| component.whole(found.bytes, i * found.stride)).collect();
        let ascending = indices.windows(2).all(|pair| pair[0] < pair[1]);
        if !ascending || indices.last().is_some_and(|last| u64::from(*last) >= count) {
            return Err(Refused(format!("its sparse indices must ascend and stay below {count}")));
        }
        Ok(Sparse { indices, values })
    }
}

/// What indices are stored as.
pub const INDICES: [Component; 3] = [Component::U8, Component::U16, Component::U32];
