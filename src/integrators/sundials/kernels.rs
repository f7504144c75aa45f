//! Faster versions of the vector operations in which integrators of small and middle-sized systems
//! spend most of their own time.
//!
//! The serial vector of SUNDIALS processes its numbers one at a time; the loops below are
//! written so that the compiler turns them into vector instructions. Vectors that SUNDIALS clones
//! inherit the operations.

use std::slice;

use super::{
    ffi,
    serial::{self, parts},
    signs,
};

/// Gives `vector`, and all its later clones, the operations of this module.
///
/// # Safety
/// `vector` is a live serial vector.
pub(super) unsafe fn install(vector: ffi::N_Vector) {
    // SAFETY: the operations table of a live vector is writable.
    unsafe {
        let ops = &mut *(*vector).ops;
        ops.nvwrmsnorm = Some(weighted_norm);
        ops.nvlinearsum = Some(linear_sum);
        ops.nvlinearcombination = Some(linear_combination);
        ops.nvconst = Some(constant);
        ops.nvscale = Some(scale);
        ops.nvabs = Some(abs);
        ops.nvinv = Some(inv);
        ops.nvaddconst = Some(add_const);
        ops.nvconstrmask = Some(signs::mask);
        ops.nvminquotient = Some(signs::least_part);
    }
}

/// sqrt(sum_i (x_i w_i)^2 / n), summed in eight interleaved parts.
///
/// A NaN is returned as infinity: C tests whether norms are too large, and NaN never is.
unsafe extern "C" fn weighted_norm(x: ffi::N_Vector, w: ffi::N_Vector) -> f64 {
    // SAFETY: SUNDIALS passes live vectors of equal length, and nothing writes to them here.
    let (x, w) = unsafe { (serial::slice(x), serial::slice(w)) };
    let (x_blocks, x_rest) = x.as_chunks::<8>();
    let (w_blocks, w_rest) = w.as_chunks::<8>();
    let mut sums = [0.0; 8];
    for (x, w) in x_blocks.iter().zip(w_blocks) {
        for k in 0..8 {
            let product = x[k] * w[k];
            sums[k] += product * product;
        }
    }
    let rest: f64 = x_rest.iter().zip(w_rest).map(|(x, w)| (x * w) * (x * w)).sum();
    let norm = ((sums.iter().sum::<f64>() + rest) / x.len() as f64).sqrt();
    if norm.is_nan() { f64::INFINITY } else { norm }
}

/// z = a x + b y, where z may be x or y.
unsafe extern "C" fn linear_sum(
    a: f64,
    x: ffi::N_Vector,
    b: f64,
    y: ffi::N_Vector,
    z: ffi::N_Vector,
) {
    // SAFETY: SUNDIALS passes live vectors of equal length; two of them are either the same or do
    // not overlap, and each case makes references only to different ones.
    unsafe {
        let ((x, n), (y, _), (z, _)) = (parts(x), parts(y), parts(z));
        if z == x && z == y {
            for z in slice::from_raw_parts_mut(z, n) {
                *z = a * *z + b * *z;
            }
        } else if z == x {
            let y = slice::from_raw_parts(y, n);
            for (z, y) in slice::from_raw_parts_mut(z, n).iter_mut().zip(y) {
                *z = a * *z + b * y;
            }
        } else if z == y {
            let x = slice::from_raw_parts(x, n);
            for (z, x) in slice::from_raw_parts_mut(z, n).iter_mut().zip(x) {
                *z = a * x + b * *z;
            }
        } else {
            let (x, y) = (slice::from_raw_parts(x, n), slice::from_raw_parts(y, n));
            for ((z, x), y) in slice::from_raw_parts_mut(z, n).iter_mut().zip(x).zip(y) {
                *z = a * x + b * y;
            }
        }
    }
}

/// z = sum_i c_i x_i, from the first to the last, where z may be the first.
unsafe extern "C" fn linear_combination(
    count: i32,
    c: *mut f64,
    x: *mut ffi::N_Vector,
    z: ffi::N_Vector,
) -> i32 {
    const BLOCK: usize = 8;
    // SAFETY: SUNDIALS passes as many numbers and live vectors of equal length, of which only the first may be z; no numbers are read after
    // those of z at the same places were written.
    unsafe {
        let (c, x) =
            (slice::from_raw_parts(c, count as usize), slice::from_raw_parts(x, count as usize));
        let (z, n) = parts(z);
        let mut start = 0;
        while start < n {
            let length = BLOCK.min(n - start);
            let mut sums = [0.0; BLOCK];
            for (k, (c, x)) in c.iter().zip(x).enumerate() {
                let x = slice::from_raw_parts(parts(*x).0.add(start), length);
                if let Ok(x) = <&[f64; BLOCK]>::try_from(x) {
                    sums =
                        std::array::from_fn(|i| if k == 0 { c * x[i] } else { c * x[i] + sums[i] });
                } else {
                    for (sum, x) in sums.iter_mut().zip(x) {
                        *sum = if k == 0 { c * x } else { c * x + *sum };
                    }
                }
            }
            slice::from_raw_parts_mut(z.add(start), length).copy_from_slice(&sums[..length]);
            start += length;
        }
    }
    0
}

/// z = f(x), where z may be x.
///
/// # Safety
/// The vectors are live serial vectors of equal length.
#[inline(always)]
unsafe fn map(x: ffi::N_Vector, z: ffi::N_Vector, f: impl Fn(f64) -> f64) {
    // SAFETY: the caller vouches for the vectors; they are either the same or do not overlap.
    unsafe {
        let ((x, n), (z, _)) = (parts(x), parts(z));
        if z == x {
            for z in slice::from_raw_parts_mut(z, n) {
                *z = f(*z);
            }
        } else {
            let x = slice::from_raw_parts(x, n);
            for (z, x) in slice::from_raw_parts_mut(z, n).iter_mut().zip(x) {
                *z = f(*x);
            }
        }
    }
}

/// z = c
unsafe extern "C" fn constant(c: f64, z: ffi::N_Vector) {
    // SAFETY: SUNDIALS passes live vectors.
    unsafe { map(z, z, |_| c) }
}

/// z = c x
unsafe extern "C" fn scale(c: f64, x: ffi::N_Vector, z: ffi::N_Vector) {
    // SAFETY: SUNDIALS passes live vectors of equal length.
    unsafe { map(x, z, |x| c * x) }
}

/// z = |x|
unsafe extern "C" fn abs(x: ffi::N_Vector, z: ffi::N_Vector) {
    // SAFETY: as in `scale`.
    unsafe { map(x, z, f64::abs) }
}

/// z = 1 / x
unsafe extern "C" fn inv(x: ffi::N_Vector, z: ffi::N_Vector) {
    // SAFETY: as in `scale`.
    unsafe { map(x, z, |x| 1.0 / x) }
}

/// z = x + b
unsafe extern "C" fn add_const(x: ffi::N_Vector, b: f64, z: ffi::N_Vector) {
    // SAFETY: as in `scale`.
    unsafe { map(x, z, |x| x + b) }
}

#[cfg(test)]
mod tests {
    use super::{
        super::{context::Context, vector::Vector},
        *,
    };

    fn vectors(n: usize, context: &Context) -> [Vector; 3] {
        [1.0, 2.0, 3.0].map(|phase| {
            let values: Vec<f64> = (0..n).map(|i| (phase * i as f64 + phase).sin()).collect();
            Vector::from_slice(&values, context).unwrap()
        })
    }

    #[test]
    fn the_kernels_do_what_sundials_does() {
        let context = Context::new().unwrap();
        for n in [1, 7, 8, 9, 100] {
            let [x, w, _] = vectors(n, &context);
            // SAFETY: the vectors are alive and of equal length.
            let (ours, theirs) = unsafe {
                (ffi::N_VWrmsNorm(x.raw(), w.raw()), ffi::N_VWrmsNorm_Serial(x.raw(), w.raw()))
            };
            // The order of summation differs.
            assert!((ours - theirs).abs() < 1e-15 * n as f64, "{n}: {ours} {theirs}");

            // Which of x, y and z (0, 1, 2) take part; equal numbers are the same vector.
            for [x, y, z] in [[0, 1, 2], [0, 1, 0], [0, 1, 1], [0, 0, 2], [0, 0, 0]] {
                for (a, b) in [(1.0, 1.0), (1.0, -1.0), (2.0, 3.0), (-1.0, 0.5)] {
                    let (ours, theirs) = (vectors(n, &context), vectors(n, &context));
                    // SAFETY: as above.
                    unsafe {
                        ffi::N_VLinearSum(a, ours[x].raw(), b, ours[y].raw(), ours[z].raw());
                        let v = &theirs;
                        ffi::N_VLinearSum_Serial(a, v[x].raw(), b, v[y].raw(), v[z].raw());
                    }
                    check(&ours, &theirs, 1e-15);
                }
            }
        }
    }

    #[test]
    fn combinations_are_those_of_sundials() {
        let context = Context::new().unwrap();
        let mut c = [0.7, -1.3, 2.1];
        for n in [1, 7, 8, 9, 100] {
            for count in 1..=3 {
                // the result is a vector of its own, or the first one
                for into_first in [true, false] {
                    let (ours, theirs) = (vectors(n, &context), vectors(n, &context));
                    let results = [&ours, &theirs].map(|_| vectors(n, &context));
                    let into = |v: &[Vector; 3], own: &[Vector; 3]| match into_first {
                        true => v[0].raw(),
                        false => own[0].raw(),
                    };
                    let z = [into(&ours, &results[0]), into(&theirs, &results[1])];
                    let [mut v, mut w] = [&ours, &theirs].map(|v| v.each_ref().map(Vector::raw));
                    // SAFETY: the vectors are alive and of equal length.
                    unsafe {
                        let c = c.as_mut_ptr();
                        ffi::N_VLinearCombination(count, c, v.as_mut_ptr(), z[0]);
                        ffi::N_VLinearCombination_Serial(count, c, w.as_mut_ptr(), z[1]);
                    }
                    check(&ours, &theirs, 1e-15);
                    check(&results[0], &results[1], 1e-15);
                }
            }
        }
    }

    #[test]
    fn operations_on_one_vector_do_what_sundials_does() {
        let context = Context::new().unwrap();
        for n in [1, 7, 100] {
            for z in [0, 2] {
                let (ours, theirs) = (vectors(n, &context), vectors(n, &context));
                let (v, w) = (&ours, &theirs);
                // SAFETY: the vectors are alive and of equal length.
                unsafe {
                    ffi::N_VAbs(v[0].raw(), v[z].raw());
                    ffi::N_VAbs_Serial(w[0].raw(), w[z].raw());
                    ffi::N_VScale(3.0, v[z].raw(), v[0].raw());
                    ffi::N_VScale_Serial(3.0, w[z].raw(), w[0].raw());
                    ffi::N_VAddConst(v[0].raw(), 2.0, v[z].raw());
                    ffi::N_VAddConst_Serial(w[0].raw(), 2.0, w[z].raw());
                    ffi::N_VInv(v[z].raw(), v[0].raw());
                    ffi::N_VInv_Serial(w[z].raw(), w[0].raw());
                    ffi::N_VConst(0.1, v[1].raw());
                    ffi::N_VConst_Serial(0.1, w[1].raw());
                }
                check(&ours, &theirs, 0.0);
            }
        }
    }

    fn check(ours: &[Vector], theirs: &[Vector], tolerance: f64) {
        for (ours, theirs) in ours.iter().zip(theirs) {
            for (ours, theirs) in ours.as_slice().iter().zip(theirs.as_slice()) {
                assert!((ours - theirs).abs() <= tolerance, "{ours} {theirs}");
            }
        }
    }

    #[test]
    fn clones_inherit_the_kernels() {
        let context = Context::new().unwrap();
        let [x, ..] = vectors(3, &context);
        // SAFETY: the vector is alive; the clone is destroyed.
        unsafe {
            let clone = ffi::N_VClone(x.raw());
            let (ours, theirs) = ((*(*x.raw()).ops).nvlinearsum, (*(*clone).ops).nvlinearsum);
            assert_eq!(ours.map(|f| f as usize), theirs.map(|f| f as usize));
            ffi::N_VDestroy(clone);
        }
    }
}
