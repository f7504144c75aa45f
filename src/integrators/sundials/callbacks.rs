//! The C functions that SUNDIALS calls.

/// Defines C functions that SUNDIALS calls, with the [`Host`](super::host::Host) of a solver as their data.
///
/// An argument is a vector, which the body sees as a slice (`read`, or `write` to be filled), `(data S)`, the host of a
/// system `S`, or, with the name of that argument, `(time host)`, a time that C counts from the start, `(roots host)` or
/// `(stored host)`, the numbers of a matrix;
/// `(result T)` is a place for a value. All others are as C has them; `vector` is one that is not used.
macro_rules! callbacks {
    ($(
        $(#[$doc:meta])*
        fn $name:ident<$($type:ident: $bound:ident),+>($($argument:tt: $kind:tt),+) $body:block
    )+) => {$(
        $(#[$doc])*
        #[allow(clippy::too_many_arguments)] // as C has it
        pub(in crate::integrators::sundials) unsafe extern "C" fn $name<$($type: $bound),+>(
            $($argument: $crate::integrators::sundials::callbacks::callbacks!(@type $kind)),+
        ) -> i32 {
            $($crate::integrators::sundials::callbacks::callbacks!(@host $argument $kind);)+
            $($crate::integrators::sundials::callbacks::callbacks!(@bind $argument $kind);)+
            $body
        }
    )+};

    (@type read) => { $crate::integrators::sundials::ffi::N_Vector };
    (@type write) => { $crate::integrators::sundials::ffi::N_Vector };
    (@type vector) => { $crate::integrators::sundials::ffi::N_Vector };
    (@type (data $system:ty)) => { *mut std::ffi::c_void };
    (@type (time $host:ident)) => { f64 };
    (@type (roots $host:ident)) => { *mut f64 };
    (@type (stored $host:ident)) => { $crate::integrators::sundials::ffi::SUNMatrix };
    (@type (result $type:ty)) => { *mut $type };
    (@type ($type:ty)) => { $type };
    (@type $type:ty) => { $type };

    (@host $host:ident (data $system:ty)) => {
        // SAFETY: the data is the host that was registered, of this type, which nobody else uses during the call.
        let $host = unsafe { $crate::integrators::sundials::host::Host::<$system>::of($host) };
    };
    (@host $argument:tt $kind:tt) => {};

    (@bind $vector:ident read) => {
        // SAFETY: vectors are serial and live, and no other one that is filled is the same.
        let $vector = unsafe { $crate::integrators::sundials::serial::slice($vector) };
    };
    (@bind $vector:ident write) => {
        // SAFETY: vectors are serial and live, and no other one is the same.
        let $vector = unsafe { $crate::integrators::sundials::serial::slice_mut($vector) };
    };
    (@bind $t:ident (time $host:ident)) => {
        let $t = $host.time_of_call($t);
    };
    (@bind $g:ident (roots $host:ident)) => {
        // SAFETY: there are as many places as root functions were declared.
        let $g = unsafe { std::slice::from_raw_parts_mut($g, $host.root_count) };
    };
    (@bind $matrix:ident (stored $host:ident)) => {
        // SAFETY: SUNDIALS passes a matrix that was made for the linear solver of the host, or for one of the same form.
        let $matrix = unsafe { $host.stored($matrix) };
    };
    (@bind $result:ident (result $type:ty)) => {
        // SAFETY: it is a valid place for the result.
        let $result = unsafe { &mut *$result };
    };
    (@bind $argument:tt $kind:tt) => {};
}
pub(super) use callbacks;
