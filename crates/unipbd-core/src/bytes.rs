//! Plain values as little-endian bytes, and a reader that never passes the end.

use crate::math::Vector;
use crate::phase::Phase;

/// A value of fixed size.
pub(crate) trait Plain: Copy {
    /// Size of the value in bytes.
    const SIZE: usize;
    /// Appends the value.
    fn put(self, out: &mut Vec<u8>);
    /// Reads the value from exactly [`SIZE`](Self::SIZE) bytes; `None` if they are invalid.
    fn take(bytes: &[u8]) -> Option<Self>;
}

macro_rules! plain_numbers {
    ($($type:ty),*) => {
        $( impl Plain for $type {
            const SIZE: usize = size_of::<$type>();
            fn put(self, out: &mut Vec<u8>) {
                out.extend_from_slice(&self.to_le_bytes());
            }
            fn take(bytes: &[u8]) -> Option<Self> {
                bytes.try_into().ok().map(<$type>::from_le_bytes)
            }
        } )*
    };
}
plain_numbers!(u16, u32, u64, f32, f64);

impl Plain for Vector {
    const SIZE: usize = size_of::<Vector>();
    fn put(self, out: &mut Vec<u8>) {
        self.x.put(out);
        self.y.put(out);
    }
    fn take(bytes: &[u8]) -> Option<Self> {
        let (x, y) = bytes.split_at_checked(Self::SIZE / 2)?;
        Some(Vector::new(Plain::take(x)?, Plain::take(y)?))
    }
}

impl Plain for Phase {
    const SIZE: usize = 1;
    fn put(self, out: &mut Vec<u8>) {
        out.push(self as u8);
    }
    fn take(bytes: &[u8]) -> Option<Self> {
        Phase::from_code(*bytes.first()?)
    }
}

/// Description of the error in the bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Damage(pub &'static str);

/// Appends values.
#[derive(Default)]
pub(crate) struct Writer(pub Vec<u8>);

impl Writer {
    pub fn value<T: Plain>(&mut self, value: T) {
        value.put(&mut self.0);
    }

    pub fn column<T: Plain>(&mut self, column: &[T]) {
        self.value(column.len() as u64);
        self.0.reserve(column.len() * T::SIZE);
        column.iter().for_each(|&value| value.put(&mut self.0));
    }

    pub fn text(&mut self, text: &str) {
        self.value(text.len() as u64);
        self.0.extend_from_slice(text.as_bytes());
    }
}

/// Reads values from the front.
pub(crate) struct Reader<'a>(pub &'a [u8]);

impl<'a> Reader<'a> {
    fn bytes(&mut self, count: usize) -> Result<&'a [u8], Damage> {
        let (taken, rest) = self.0.split_at_checked(count).ok_or_else(|| damaged("it ends too early"))?;
        self.0 = rest;
        Ok(taken)
    }

    pub fn value<T: Plain>(&mut self) -> Result<T, Damage> {
        T::take(self.bytes(T::SIZE)?).ok_or_else(|| damaged("a value means nothing"))
    }

    pub fn column<T: Plain>(&mut self) -> Result<Vec<T>, Damage> {
        let count = self.count(T::SIZE)?;
        let bytes = self.bytes(count * T::SIZE)?;
        let values: Option<Vec<T>> = bytes.chunks_exact(T::SIZE).map(T::take).collect();
        values.ok_or_else(|| damaged("a value means nothing"))
    }

    pub fn text(&mut self) -> Result<String, Damage> {
        let count = self.count(1)?;
        String::from_utf8(self.bytes(count)?.to_vec()).map_err(|_| damaged("a name is not UTF-8"))
    }

    /// A number of elements of this size, no more than there are bytes left for.
    pub fn count(&mut self, size: usize) -> Result<usize, Damage> {
        let count = self.value::<u64>()?;
        let most = (self.0.len() / size) as u64;
        if count > most { Err(damaged("it ends too early")) } else { Ok(count as usize) }
    }
}

fn damaged(what: &'static str) -> Damage {
    Damage(what)
}

/// Memory held by a column \[bytes].
#[allow(clippy::ptr_arg)] // The capacity counts.
pub(crate) fn held<T>(column: &Vec<T>) -> usize {
    column.capacity() * size_of::<T>()
}
