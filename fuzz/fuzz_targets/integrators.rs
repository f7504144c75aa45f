//! Random problems with random options: `cargo +nightly fuzz run integrators`. What has to hold stands in `case`.

#![no_main]

mod case;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    case::run(bytes);
});
