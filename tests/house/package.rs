//! The package of a registry: what is in it, where the README leads, and what compiler and releases it takes.

use std::path::Path;
use std::process::Command;
use std::{env, fs};

/// Output of cargo.
fn cargo(arguments: &[&str]) -> String {
    let mut cargo = Command::new(env::var_os("CARGO").unwrap_or("cargo".into()));
    let output = cargo.args(arguments).current_dir(env!("CARGO_MANIFEST_DIR")).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// Where the links and pictures of a page in Markdown lead, other pages of the web apart.
fn links(page: &str) -> impl Iterator<Item = &str> {
    let targets = page.split("](").skip(1).map(|rest| rest.split([')', '#']).next().unwrap());
    targets.filter(|target| !target.is_empty() && !target.contains("://"))
}

#[test]
fn the_package_is_small_and_the_readme_leads_into_it() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let list = cargo(&["package", "--package", "pliant", "--list", "--allow-dirty"]);
    let packaged: Vec<&str> = list.lines().collect();
    let sizes = packaged.iter().filter_map(|file| fs::metadata(root.join(file)).ok());
    // 7.11 MB are 1.987 MB compressed
    let size: u64 = sizes.map(|file| file.len()).sum();
    assert!(size < 7_150_000, "{size} bytes, which are more than 2 MB compressed");
    // the sources, one concept to a file, and few others
    let others = packaged.iter().filter(|file| !file.starts_with("src/")).count();
    assert!(others < 60, "{others} files besides the sources");

    let readme = fs::read_to_string(root.join("README.md")).unwrap();
    let (manual, reports) = readme.split_once("in the repository alone").unwrap();
    let is_packaged = |target: &str| {
        let within = format!("{target}/");
        packaged.iter().any(|file| *file == target || file.starts_with(&within))
    };
    // larger than all other pages together
    let manual = links(manual).filter(|target| *target != "docs/pictures/play.png");
    let gone: Vec<_> = manual.filter(|target| !is_packaged(target)).collect();
    assert!(gone.is_empty(), "not in the package (`include` in Cargo.toml): {gone:?}");
    let gone: Vec<_> = links(reports).filter(|target| !root.join(target).exists()).collect();
    assert!(gone.is_empty(), "not in the repository: {gone:?}");
    // scenes that its commands run
    let words = readme.split_whitespace().filter(|word| word.starts_with("scenes/"));
    let gone: Vec<_> = words.filter(|scene| !is_packaged(scene)).collect();
    assert!(gone.is_empty(), "not in the package: {gone:?}");
}

/// "1.89" or "1.89.0" as numbers.
fn numbers(version: &str) -> Vec<u32> {
    version.split('.').take(2).map(|part| part.parse().unwrap()).collect()
}

/// Clippy sees what the library itself takes of the standard library (`incompatible_msrv`).
#[test]
fn dependencies_are_releases_for_the_compiler_that_the_package_names() {
    let platform = format!("{}-unknown-linux-gnu", env::consts::ARCH);
    let metadata =
        cargo(&["metadata", "--format-version", "1", "--locked", "--filter-platform", &platform]);
    let metadata: serde_json::Value = serde_json::from_str(&metadata).unwrap();
    let own = numbers(env!("CARGO_PKG_RUST_VERSION"));
    let packages = metadata["packages"].as_array().unwrap();
    assert!(packages.len() > 100, "{}", packages.len());
    for package in packages {
        let (name, version) = (&package["name"], package["version"].as_str().unwrap());
        let release = version.split('+').next().unwrap();
        assert!(!release.contains('-'), "{name} {version} is no release");
        if let Some(needed) = package["rust_version"].as_str() {
            assert!(numbers(needed) <= own, "{name} {version} takes Rust {needed}");
        }
    }
}
