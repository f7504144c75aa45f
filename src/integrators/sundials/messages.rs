//! Error handlers of SUNDIALS, which keep its messages for errors in place of printing them.

use std::ffi::{CStr, c_char, c_void};

#[cfg(not(sundials_major = "6"))]
use super::ffi;
use super::{context::Context, functions::Functions, host::Host};

/// Makes an integrator of SUNDIALS 6, where each has a handler of its own, keep its messages in a host. Returns the name of
/// the C function and its code.
///
/// # Safety
/// The memory is one of these functions, and the data is a [`Host<S>`] that outlives it.
#[cfg(sundials_major = "6")]
pub(super) unsafe fn keep_in<S>(
    data: *mut c_void,
    functions: &Functions,
    memory: *mut c_void,
    _: &Context,
) -> (&'static str, i32) {
    let (name, set) = functions.set_error_handler;
    // SAFETY: the caller vouches for memory and data.
    (name, unsafe { set(memory, Some(handler::<S>), data) })
}

/// The same from SUNDIALS 7 on, where the context has a stack of handlers.
///
/// # Safety
/// The data is a [`Host<S>`] that outlives the context, or its last use.
#[cfg(not(sundials_major = "6"))]
pub(super) unsafe fn keep_in<S>(
    data: *mut c_void,
    _: &Functions,
    _: *mut c_void,
    context: &Context,
) -> (&'static str, i32) {
    // SAFETY: the context is alive; the caller vouches for the data. Without a logger warnings are not printed.
    unsafe {
        ffi::SUNContext_SetLogger(context.raw(), std::ptr::null_mut());
        ffi::SUNContext_ClearErrHandlers(context.raw());
        let code = ffi::SUNContext_PushErrHandler(context.raw(), Some(handler::<S>), data);
        ("SUNContext_PushErrHandler", code)
    }
}

/// `CVErrHandlerFn`
#[cfg(sundials_major = "6")]
unsafe extern "C" fn handler<S>(
    code: i32,
    _module: *const c_char,
    _function: *const c_char,
    message: *mut c_char,
    data: *mut c_void,
) {
    // SAFETY: SUNDIALS passes the data that was registered with this handler, and null or a message.
    unsafe { keep::<S>(code, message, data) }
}

/// `SUNErrHandlerFn`
#[cfg(not(sundials_major = "6"))]
unsafe extern "C" fn handler<S>(
    _line: i32,
    _function: *const c_char,
    _file: *const c_char,
    message: *const c_char,
    code: ffi::SUNErrCode,
    data: *mut c_void,
    _context: ffi::SUNContext,
) {
    // SAFETY: as above.
    unsafe { keep::<S>(code, message, data) }
}

/// # Safety
/// `data` points to a live [`Host<S>`] that nobody else uses; `message` is null or a C string.
unsafe fn keep<S>(code: i32, message: *const c_char, data: *mut c_void) {
    if !message.is_null() {
        // SAFETY: the caller vouches for both; callbacks that also use the host have returned.
        unsafe { Host::<S>::of(data).troubles.keep_message(code, CStr::from_ptr(message)) };
    }
}
