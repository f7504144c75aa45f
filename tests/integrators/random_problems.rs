//! Random problems with random options: the fuzz target, for a while.
//!
//! More of them: `PLIANT_SEEDS=0..1000000 cargo test --test integrators random_problems -- --nocapture`, or
//! `cargo +nightly fuzz run integrators`.

#[path = "../../fuzz/fuzz_targets/case/mod.rs"]
mod case;

use std::{collections::BTreeMap, env, fs, ops::Range, path::Path};

use case::{Outcome, run};

/// Bytes of a seed: splitmix64.
fn bytes(seed: u64) -> Vec<u8> {
    let mut state = seed;
    let mut word = || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z ^ (z >> 31)).to_le_bytes()
    };
    (0..20).flat_map(|_| word()).collect()
}

fn seeds() -> Range<u64> {
    let given = env::var("PLIANT_SEEDS").unwrap_or("0..3000".into());
    let (from, to) = given.split_once("..").expect("a range");
    from.parse().expect("a number")..to.parse().expect("a number")
}

#[test]
fn nothing_panics_or_hangs_and_what_goes_well_is_right() {
    // planned panics are many
    let hook = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |info| {
        if info.payload().downcast_ref::<&str>() != Some(&"planned") {
            hook(info);
        }
    }));
    let mut counts = BTreeMap::<String, usize>::new();
    for seed in seeds() {
        if env::var_os("PLIANT_SEEDS").is_some() && seed % 100_000 == 0 {
            println!("{seed}: {counts:?}");
        }
        let outcome = std::panic::catch_unwind(|| run(&bytes(seed)));
        let outcome = outcome.unwrap_or_else(|_| panic!("seed {seed}"));
        *counts.entry(format!("{outcome:?}")).or_default() += 1;
    }
    println!("{counts:?}");
    // all ways to end are met
    let part = |outcome: Outcome| {
        let count = counts.get(&format!("{outcome:?}")).copied().unwrap_or(0);
        count as f64 / seeds().count() as f64
    };
    for outcome in [Outcome::Refused, Outcome::Failed, Outcome::Panicked, Outcome::Done] {
        assert!(part(outcome) > 0.01, "{outcome:?}: {counts:?}");
    }
}

/// Cases that once went wrong, and some of each kind.
#[test]
fn kept_cases_hold() {
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus/integrators");
    let mut count = 0;
    for entry in fs::read_dir(corpus).unwrap() {
        run(&fs::read(entry.unwrap().path()).unwrap());
        count += 1;
    }
    assert!(count > 0);
}
