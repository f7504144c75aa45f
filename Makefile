.DEFAULT_GOAL := help
.PHONY: help setup demo test python bench baseline advice charts stability validation peers pictures docs package features semver valgrind miri clean

VALGRIND := valgrind --leak-check=full --error-exitcode=1 \
	--errors-for-leak-kinds=definite,indirect

help: ## Show this list
	@sed -n 's/^\([a-z]*\):.*## \(.*\)/  make \1\t\2/p' $(MAKEFILE_LIST) | expand -t 18

setup: ## Install the Debian packages of packages.txt that are missing
	@scripts/setup.sh

demo: setup ## The jumping square and a scene file by the command: tables here, pictures in out/
	cargo run --release --example square_jump -- --nodes 4
	cargo run --release --example square_jump -- --nodes 10
	cargo run --release -- run scenes/ring-jump.toml --formats svg,html
	@echo "The pictures are in $(CURDIR)/out:"
	@find out -name '*.svg' -o -name '*.html' | sort | sed 's/^/  /'

# Kernels for AVX-512 are compiled where they can run.
AVX512 := $(shell grep -qsw avx512f /proc/cpuinfo && echo ,pliant/avx512)
FEATURES := --no-default-features --features pliant/cli,pliant/play,pliant/shared$(AVX512)
# The library and the Python module: crates that both need are compiled once, with the features of both.
BOTH := -p pliant -p pliant-python $(FEATURES)

# An extension module finds Python's functions in the program that loads it.
export PYO3_BUILD_EXTENSION_MODULE := 1

# What is only read, by clippy and rustdoc, is not optimized, and is read once for both.
READ := --config profile.dev.opt-level=0

# Examples are checked by clippy; these have tests of their own.
TESTED := --example gallery --example integrators

# Unit tests are short: to optimize them, which compiles the library once more, would take longer than to run them as they are.
# What the tests run beside themselves, a browser and Python, is fetched while clippy computes. Where a compiler, rustdoc, Python or
# the last test of a program takes one core, another job has the other: unit tests, which are compiled first, run while the next
# ones are compiled, and those run in two halves beside all that comes last.
test: export RUSTC_WORKSPACE_WRAPPER := $(CURDIR)/scripts/rustc
test: ## Every check: format, lints, tests, documentation and its examples
	@scripts/setup.sh
	cargo fmt --all --check
	{ scripts/setup.sh chromium python3-venv && scripts/python.sh environment; } & \
		cargo clippy --workspace --all-targets $(FEATURES) $(READ) -- -D warnings && wait $$!
	cargo test -p pliant $(FEATURES) --lib --config profile.dev.package.pliant.opt-level=0 & \
		sleep 2; cargo test $(BOTH) --test '*' $(TESTED) --no-run && wait $$!
	cargo test $(BOTH) --test 's*' & some=$$!; cargo test $(BOTH) --test '[!s]*' $(TESTED) & others=$$!; \
		cargo test $(BOTH) --doc && RUSTDOCFLAGS=-Dwarnings cargo doc $(BOTH) --no-deps $(READ) && \
		scripts/python.sh test $(BOTH) && wait $$some && wait $$others

python: ## The wheel of the Python module, made, installed into an environment of its own, and tested there
	@scripts/setup.sh python3-venv
	scripts/python.sh wheel

bench: ## What cells and the parts of steps cost, and what has become slower; all others: cargo bench
	@scripts/setup.sh valgrind
	cargo bench --bench table
	cargo run --release -p counts

baseline: ## The numbers of instructions that `make bench` compares with, stored anew
	@scripts/setup.sh valgrind
	cargo run --release -p counts -- --store

charts: setup ## docs/charts and docs/integrators.md, some 20 minutes; out/ keeps what was run
	cargo run --release --example gallery -- --out docs/charts
	cargo run --release --example integrators -- --out docs

advice: setup ## docs/advice.md, tests of the adviser, some 10 minutes
	cargo run --release --example advice

stability: setup ## docs/stability.md with its pictures, some minutes
	cargo run --release --example stability

validation: setup ## docs/validation.md, a beam and an arm that were measured, some minutes
	cargo run --release --example measured_beam
	cargo run --release --example measured_arm

peers: setup ## Compare with SciPy, Octave, diffsol and others (peers/README.md)
	peers/run

pictures: ## docs/pictures/play.png, the page of `pliant play`
	@scripts/setup.sh chromium
	cargo run --release --features play --example play_picture

docs: setup ## Documentation of the library
	cargo doc --no-deps
	@echo "Open $(CURDIR)/target/doc/pliant/index.html"

package: ## The package for a registry, built by itself from what is in it, and its documentation as docs.rs builds it
	@scripts/setup.sh cmake
	cargo package -p pliant $(READ)
	DOCS_RS=1 RUSTDOCFLAGS=-Dwarnings cargo doc -p pliant --no-deps --features play,png,study,vendored $(READ)
	@ls -l target/package/*.crate

# None, each alone, all; `-D warnings` of clippy is for pliant alone, where that of the compiler would build all dependencies anew.
features: ## The library with none, each alone and all of its features: no warnings
	@scripts/setup.sh cmake
	@set -e; for feature in "" $$(sed -n '/^\[features\]/,/^\[dep/s/^\([a-z0-9-]*\) = .*/\1/p' Cargo.toml); do \
		echo "feature: $$feature"; \
		cargo clippy --quiet -p pliant --lib --no-default-features --features "$$feature" $(READ) -- -D warnings; done
	cargo clippy --quiet -p pliant --lib --bins --all-features $(READ) -- -D warnings

# It documents all features, `vendored` among them.
semver: ## What the public interface changes since the last commit, by cargo-semver-checks (cargo install cargo-semver-checks)
	@scripts/setup.sh cmake
	cargo semver-checks -p pliant --baseline-rev HEAD

# The runner of the test binary is valgrind; PLIANT_LIFECYCLES sets the rounds of 30 solvers.
valgrind: export PLIANT_LIFECYCLES ?= 100
valgrind: ## Thousands of SUNDIALS solvers under valgrind: no leak, no invalid access
	@scripts/setup.sh valgrind
	cargo test --test integrators lifecycle --config 'target."cfg(all())".runner = "$(VALGRIND)"'

# What calls no C; it takes `rustup toolchain install nightly --component miri`. Runs are compared bit by bit, which
# the noise that Miri adds to powers and sines would change.
miri: export MIRIFLAGS := -Zmiri-deterministic-floats
miri: setup ## Some tests of the parts without C under Miri: no undefined behaviour, no data race
	cargo +nightly miri test --no-default-features --features fit,sweep --test integrators -- \
		rk::failures rk::steps patterns --skip stability --skip klu
	cargo +nightly miri test --no-default-features --features fit,sweep --test solving -- breaks ensembles

clean: ## Remove everything built and every picture made
	cargo clean
	rm -rf out
