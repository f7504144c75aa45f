//! Where methods and models fail, and what works instead: the conclusions of `docs/stability.md`, by
//! the experiments of the example that writes it, on small cases.

#[allow(dead_code)] // the tests run experiments; the example, which has the page, uses all
#[path = "../../examples/stability/gallery/mod.rs"]
mod gallery;

mod alpha;
mod compression;
mod contact;
mod explicit;
mod index;
mod locking;
mod orders;
mod pulses;
mod rotation;
