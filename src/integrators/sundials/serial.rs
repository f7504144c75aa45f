//! The numbers of serial vectors, the only ones of this layer.

use std::slice;

use super::ffi;

/// Start and length of a vector.
///
/// # Safety
/// `vector` is a live serial vector.
pub(super) unsafe fn parts(vector: ffi::N_Vector) -> (*mut f64, usize) {
    // SAFETY: the caller vouches for the vector, whose content is of this type.
    unsafe {
        let content = &*(*vector).content.cast::<ffi::_N_VectorContent_Serial>();
        (content.data, content.length as usize)
    }
}

/// The numbers of a vector.
///
/// # Safety
/// `vector` is a live serial vector that is not empty, and nobody writes to it during `'a`.
pub(super) unsafe fn slice<'a>(vector: ffi::N_Vector) -> &'a [f64] {
    // SAFETY: the caller vouches for the vector; serial vectors are contiguous.
    unsafe {
        let (data, len) = parts(vector);
        slice::from_raw_parts(data, len)
    }
}

/// The numbers of a vector that is to be filled.
///
/// # Safety
/// `vector` is a live serial vector that is not empty, and nobody else uses it during `'a`.
pub(super) unsafe fn slice_mut<'a>(vector: ffi::N_Vector) -> &'a mut [f64] {
    // SAFETY: the caller vouches for the vector; serial vectors are contiguous.
    unsafe {
        let (data, len) = parts(vector);
        slice::from_raw_parts_mut(data, len)
    }
}
