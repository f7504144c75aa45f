//! Versions of the linked libraries.

use std::ffi::{CStr, c_char};

use super::ffi;

/// Version of the linked SUNDIALS library, such as "6.4.1". (`SUNDIALSGetVersion`)
#[must_use]
pub fn version() -> String {
    const LENGTH: usize = 64;
    let mut text: [c_char; LENGTH] = [0; LENGTH];
    // SAFETY: the library writes a terminated string of at most `LENGTH - 1` characters, or
    // nothing if it is longer; the last place is 0 in any case.
    let text = unsafe {
        ffi::SUNDIALSGetVersion(text.as_mut_ptr(), LENGTH as i32 - 1);
        CStr::from_ptr(text.as_ptr())
    };
    text.to_string_lossy().into_owned()
}

/// Version of the linked SuiteSparse library, which KLU belongs to, such as "5.12.0". (`SuiteSparse_version`)
#[must_use]
pub fn suitesparse_version() -> String {
    let mut version = [0; 3];
    // SAFETY: there are three places, as many as it writes.
    unsafe { ffi::SuiteSparse_version(version.as_mut_ptr()) };
    version.map(|part| part.to_string()).join(".")
}

/// The linked libraries in words: versions, parts and the size of indices.
#[must_use]
pub fn description() -> String {
    format!(
        "SUNDIALS {} with CVODES, IDAS, ARKODE, {}-bit indices; KLU of SuiteSparse {}",
        version(),
        ffi::sunindextype::BITS,
        suitesparse_version()
    )
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_description_has_both_versions() {
        let words = super::description();
        assert!(words.starts_with(&format!("SUNDIALS {} ", super::version())), "{words}");
        assert!(words.ends_with(&super::suitesparse_version()), "{words}");
    }

    /// The libraries are those whose headers the crate was built with, except for the last number.
    #[test]
    fn the_linked_versions_are_those_of_the_headers() {
        let headers = [super::ffi::SUNDIALS_VERSION_MAJOR, super::ffi::SUNDIALS_VERSION_MINOR];
        let headers = headers.map(|part| part.to_string()).join(".");
        assert!(super::version().starts_with(&format!("{headers}.")), "{}", super::version());
    }
}
