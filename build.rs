//! Finds SUNDIALS and SuiteSparse KLU, checks that they are what the crate was written for, and
//! generates the bindings that `sundials-sys` lacks: ARKODE, the KLU linear solver, versions.
//!
//! `SUNDIALS_INCLUDE_DIR` and `SUNDIALS_LIBRARY_DIR` (the names that `sundials-sys` reads too)
//! point to an installation in an unusual place, `SUITESPARSE_INCLUDE_DIR` to KLU's headers.

use std::{
    env, fs, panic,
    path::{Path, PathBuf},
    process::exit,
};

use bindgen::callbacks::{IntKind, ParseCallbacks};

const PACKAGES: &str = "On Debian and Ubuntu, install what the build needs with\n\n    \
    apt-get install libsundials-dev libsuitesparse-dev libclang-dev pkg-config\n\n\
    For another installation, set SUNDIALS_INCLUDE_DIR, SUNDIALS_LIBRARY_DIR and \
    SUITESPARSE_INCLUDE_DIR (see vendor-notes.md).";

/// The headers that `sundials-sys` does not bind.
const HEADERS: &str = "\
#include <arkode/arkode.h>
#include <arkode/arkode_ls.h>
#include <arkode/arkode_arkstep.h>
#include <arkode/arkode_mristep.h>
#include <sundials/sundials_version.h>
#include <sunlinsol/sunlinsol_klu.h>
#include <SuiteSparse_config.h>
";

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    for name in ["SUNDIALS_INCLUDE_DIR", "SUNDIALS_LIBRARY_DIR", "SUITESPARSE_INCLUDE_DIR"] {
        println!("cargo::rerun-if-env-changed={name}");
    }

    let sundials = include_dir("SUNDIALS_INCLUDE_DIR", &[""], "sundials/sundials_config.h");
    let major = check_configuration(&sundials.join("sundials/sundials_config.h"));
    println!("cargo::rustc-check-cfg=cfg(sundials_major, values(\"6\", \"7\"))");
    println!("cargo::rustc-cfg=sundials_major=\"{major}\"");
    if !sundials.join("sunlinsol/sunlinsol_klu.h").is_file() {
        fail("This SUNDIALS was built without KLU: sunlinsol/sunlinsol_klu.h is missing.");
    }
    let suitesparse = include_dir("SUITESPARSE_INCLUDE_DIR", &["", "suitesparse"], "klu.h");

    generate_bindings(&[&sundials, &suitesparse]);

    if let Some(directory) = env::var_os("SUNDIALS_LIBRARY_DIR") {
        println!("cargo::rustc-link-search=native={}", Path::new(&directory).display());
    }
    for library in ["sundials_arkode", "sundials_sunlinsolklu", "klu", "suitesparseconfig"] {
        println!("cargo::rustc-link-lib={library}");
    }
}

/// The directory that holds `header`: what the environment variable says, else the usual places.
fn include_dir(variable: &str, subdirectories: &[&str], header: &str) -> PathBuf {
    let roots = match env::var_os(variable) {
        Some(directory) => vec![PathBuf::from(directory)],
        None => ["/usr/include", "/usr/local/include", "/opt/homebrew/include"]
            .iter()
            .map(PathBuf::from)
            .collect(),
    };
    for root in &roots {
        for subdirectory in subdirectories {
            let directory = root.join(subdirectory);
            if directory.join(header).is_file() {
                return directory;
            }
        }
    }
    let places: Vec<_> = roots.iter().map(|root| root.display().to_string()).collect();
    fail(&format!("The header {header} is not in {}.", places.join(", ")))
}

/// Stops unless the configuration header says: SUNDIALS 6 or 7, double precision, 64-bit indices. Returns the first number of
/// the version.
fn check_configuration(header: &Path) -> String {
    let Ok(text) = fs::read_to_string(header) else {
        fail(&format!("{} can not be read.", header.display()));
    };
    let value = |name: &str| {
        text.lines().find_map(|line| {
            let mut words = line.split_whitespace();
            (words.next() == Some("#define") && words.next() == Some(name))
                .then(|| words.next().unwrap_or_default().trim_matches('"').to_owned())
        })
    };

    let version = value("SUNDIALS_VERSION").unwrap_or_else(|| "of unknown version".into());
    let major = value("SUNDIALS_VERSION_MAJOR").unwrap_or_default();
    let minor = value("SUNDIALS_VERSION_MINOR").and_then(|minor| minor.parse::<u32>().ok());
    let is_known = match (major.as_str(), minor) {
        ("6", Some(minor)) => minor >= 4,
        ("7", _) => true,
        _ => false,
    };
    if !is_known {
        fail(&format!(
            "SUNDIALS {version} was found in {}, but pliant is written for SUNDIALS 6 from 6.4 on and for SUNDIALS 7.",
            header.display()
        ));
    }
    if value("SUNDIALS_DOUBLE_PRECISION").is_none() || value("SUNDIALS_INT64_T").is_none() {
        fail(&format!(
            "SUNDIALS {version} was found, but not with double precision and 64-bit indices \
             (SUNDIALS_PRECISION=double, SUNDIALS_INDEX_SIZE=64)."
        ));
    }
    major
}

fn generate_bindings(include_directories: &[&Path]) {
    let builder = bindgen::Builder::default()
        .header_contents("sundials_extra.h", HEADERS)
        .clang_args(include_directories.iter().map(|path| format!("-I{}", path.display())))
        .rust_target(bindgen::RustTarget::stable(88, 0).unwrap_or_default())
        .rust_edition(bindgen::RustEdition::Edition2024)
        .ctypes_prefix("libc")
        .parse_callbacks(Box::new(SignedConstants))
        // Whatever these declarations refer to is defined by `sundials-sys`.
        .allowlist_recursively(false)
        .allowlist_function("(ARKStep|MRIStep|ARKode)\\w+")
        .allowlist_function("SUNLinSol_KLU|SUNLinSol_KLUSetOrdering")
        .allowlist_function("SUNDIALSGetVersion|SuiteSparse_version")
        .allowlist_type("ARK\\w+|_?ARKodeButcherTable\\w*|_?MRI\\w+")
        .allowlist_var("ARK_\\w+|ARKODE_\\w+")
        .allowlist_var("SUITESPARSE_(MAIN|SUB)_VERSION")
        .layout_tests(false)
        .generate_comments(false);
    // bindgen panics when it does not find libclang.
    panic::set_hook(Box::new(|_| ()));
    match panic::catch_unwind(panic::AssertUnwindSafe(|| builder.generate())) {
        Ok(Ok(bindings)) => {
            let file = PathBuf::from(env::var_os("OUT_DIR").unwrap()).join("sundials_extra.rs");
            if let Err(error) = bindings.write_to_file(&file) {
                fail(&format!("{} can not be written: {error}", file.display()));
            }
        }
        Ok(Err(error)) => fail(&format!("The SUNDIALS headers can not be translated: {error}")),
        Err(_) => fail("libclang, which bindgen needs to read C headers, was not found."),
    }
}

/// Return codes and tasks are C `int`s.
#[derive(Debug)]
struct SignedConstants;

impl ParseCallbacks for SignedConstants {
    fn int_macro(&self, name: &str, _value: i64) -> Option<IntKind> {
        name.starts_with("ARK").then_some(IntKind::Int)
    }
}

fn fail(what: &str) -> ! {
    eprintln!("\npliant can not be built. {what}\n{PACKAGES}\n");
    exit(1)
}
