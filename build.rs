//! Finds SUNDIALS and SuiteSparse KLU, checks that they are what the crate was written for, and has them linked.
//!
//! `SUNDIALS_INCLUDE_DIR` and `SUNDIALS_LIBRARY_DIR` (the names that `sundials-sys` reads too) point to an installation in
//! an unusual place. With the feature `vendored` `sundials-sys` and `klu_sys` build what is linked.

use std::{
    env, fs,
    path::{Path, PathBuf},
    process::exit,
};

const PACKAGES: &str = "On Debian and Ubuntu, install what the build needs with\n\n    \
    apt-get install libsundials-dev libsuitesparse-dev libclang-dev pkg-config\n\n\
    For another installation, set SUNDIALS_INCLUDE_DIR and SUNDIALS_LIBRARY_DIR (see vendor-notes.md); or build SUNDIALS and \
    KLU from their sources, by the feature `vendored`.";

/// The SUNDIALS that `sundials-sys` carries is a 7.
const VENDORED_MAJOR: &str = "7";

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    for name in ["SUNDIALS_INCLUDE_DIR", "SUNDIALS_LIBRARY_DIR"] {
        println!("cargo::rerun-if-env-changed={name}");
    }
    println!("cargo::rustc-check-cfg=cfg(sundials_major, values(\"6\", \"7\"))");

    let major = if env::var_os("CARGO_FEATURE_VENDORED").is_some() {
        VENDORED_MAJOR.into()
    } else {
        link_installed()
    };
    println!("cargo::rustc-cfg=sundials_major=\"{major}\"");
}

/// Has the libraries linked that are installed, and returns the first number of the version of SUNDIALS.
fn link_installed() -> String {
    let headers = include_dir();
    let major = check_configuration(&headers.join("sundials/sundials_config.h"));
    if !headers.join("sunlinsol/sunlinsol_klu.h").is_file() {
        fail("This SUNDIALS was built without KLU: sunlinsol/sunlinsol_klu.h is missing.");
    }
    if let Some(directory) = env::var_os("SUNDIALS_LIBRARY_DIR") {
        println!("cargo::rustc-link-search=native={}", Path::new(&directory).display());
    }
    for library in ["sundials_arkode", "sundials_sunlinsolklu", "klu", "suitesparseconfig"] {
        println!("cargo::rustc-link-lib={library}");
    }
    major
}

/// The directory that holds the headers of SUNDIALS: what the environment variable says, else one of the usual places.
fn include_dir() -> PathBuf {
    let roots = match env::var_os("SUNDIALS_INCLUDE_DIR") {
        Some(directory) => vec![PathBuf::from(directory)],
        None => ["/usr/include", "/usr/local/include", "/opt/homebrew/include"]
            .iter()
            .map(PathBuf::from)
            .collect(),
    };
    let header = "sundials/sundials_config.h";
    let found = roots.iter().find(|root| root.join(header).is_file());
    let Some(root) = found else {
        let places: Vec<_> = roots.iter().map(|root| root.display().to_string()).collect();
        fail(&format!("The header {header} is not in {}.", places.join(", ")))
    };
    root.clone()
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

fn fail(what: &str) -> ! {
    eprintln!("\npliant can not be built. {what}\n{PACKAGES}\n");
    exit(1)
}
