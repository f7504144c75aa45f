//! The declarations of C functions in `arkode_ffi.rs`, against the headers that are installed.

use std::{env, fmt::Write, fs, path::Path, process::Command};

/// A type of Rust in C: `*mut f64` is `double *`.
fn c_type(rust: &str) -> String {
    let rust = rust.trim();
    if let Some(target) = rust.strip_prefix("*mut ") {
        return format!("{} *", c_type(target));
    }
    if let Some(target) = rust.strip_prefix("*const ") {
        return format!("const {} *", c_type(target));
    }
    match rust {
        "f64" => "double".into(),
        "c_int" => "int".into(),
        "c_long" => "long".into(),
        "c_char" => "char".into(),
        "c_void" => "void".into(),
        name => name.into(),
    }
}

/// The pointer `name` to a function, in C, of "(a: A, b: B) -> C" in Rust.
fn pointer(name: &str, signature: &str) -> String {
    let (arguments, result) = signature.trim().trim_start_matches('(').split_once(')').unwrap();
    let types = arguments.split(',').filter_map(|argument| argument.split_once(':'));
    let types: Vec<_> = types.map(|(_, rust)| c_type(rust)).collect();
    let result = result.trim().strip_prefix("->").map_or("void".into(), c_type);
    format!("{result} (*{name})({})", types.join(", "))
}

/// C code that compiles if the declarations of `text` are those of the headers, and the number of declarations.
fn check_of(text: &str, is_6: bool) -> (String, usize) {
    let mut c = String::from(
        "#include <stddef.h>\n#include <stdio.h>\n#include <cvodes/cvodes.h>\n#include <cvodes/cvodes_ls.h>\n\
         #include <arkode/arkode_arkstep.h>\n#include <arkode/arkode_mristep.h>\n\
         #include <sundials/sundials_version.h>\n#include <sunlinsol/sunlinsol_klu.h>\n#include <SuiteSparse_config.h>\n\
         _Static_assert(offsetof(struct ARKodeButcherTableMem, q) == 0, \"q\");\n",
    );
    let mut count = 0;
    for item in text.split(';') {
        let of_6_alone = item.contains("sundials_major = \"6\"") && item.contains("pub fn");
        if of_6_alone && !is_6 {
            continue;
        }
        let Some((_, item)) = item.split_once("pub ") else { continue };
        if let Some((name, value)) =
            item.strip_prefix("const ").and_then(|i| i.split_once(": c_int = "))
        {
            writeln!(c, "_Static_assert({name} == {value}, \"{name}\");").unwrap();
        } else if let Some((name, signature)) =
            item.strip_prefix("fn ").and_then(|i| i.split_once('('))
        {
            writeln!(c, "{} = {name};", pointer(&format!("check_{name}"), signature)).unwrap();
        } else if let Some((name, signature)) = item
            .strip_prefix("type ")
            .and_then(|i| i.split_once('='))
            .and_then(|(name, i)| Some((name.trim(), i.split_once("extern \"C\" fn")?.1)))
        {
            let signature = signature.trim_end().trim_end_matches([',', '>', '\n']);
            writeln!(c, "{} = ({name})0;", pointer(&format!("check_{name}"), signature)).unwrap();
        } else {
            continue;
        }
        count += 1;
    }
    (c, count)
}

/// Whether the C compiler takes the code, and what it says.
fn compiles(code: &str) -> (bool, String) {
    let file = env::temp_dir().join(format!("pliant-headers-{}.c", std::process::id()));
    fs::write(&file, code).unwrap();
    let mut compiler = Command::new("cc");
    compiler.args(["-std=c11", "-fsyntax-only", "-Werror=incompatible-pointer-types"]);
    if let Some(directory) = env::var_os("SUNDIALS_INCLUDE_DIR") {
        compiler.arg("-I").arg(directory);
    }
    let output = compiler.arg("-I/usr/include/suitesparse").arg(&file).output().unwrap();
    fs::remove_file(&file).unwrap();
    (output.status.success(), String::from_utf8_lossy(&output.stderr).into_owned())
}

#[test]
fn declarations_are_those_of_the_headers() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/integrators/sundials/arkode_ffi.rs");
    let text = fs::read_to_string(path).unwrap();
    let is_6 = pliant::sundials::version().starts_with("6.");
    let (code, count) = check_of(&text, is_6);
    assert!(count > 160, "{count}: does this test still see the declarations?");
    let (good, words) = compiles(&code);
    assert!(good, "{words}");

    // and each kind of mistake is seen
    for (right, wrong) in [
        ("ARK_BAD_T: c_int = -25", "ARK_BAD_T: c_int = -24"),
        ("mxsteps: c_long", "mxsteps: c_int"),
        ("hstab: *mut f64", "hstab: *mut c_int"),
    ] {
        assert!(text.contains(right), "{right}");
        assert!(!compiles(&check_of(&text.replace(right, wrong), is_6).0).0, "{wrong} is not seen");
    }
}
