//! Properties of every law, checked by the same functions at random deformations of cells of every dimension in
//! every space.

use nalgebra::{Rotation3, Vector3};
use num_dual::DualNum;
use pulp::{Scalar, Simd, WithSimd};

use super::hookean_viscosity::HookeanViscosity;
use super::newtonian::NewtonianViscosity;
use super::*;
use crate::base::lane::{Lane, SIDE_BY_SIDE};
use crate::base::simd::at_once;
use crate::base::tensor::{Matrix, Real, dot, product};
use crate::elements::material::{Blocks, Deformation, ElasticLaw, Lame, Material, Plane};

/// Moduli of a soft material, Pa.
const LAME: Lame = Lame { lambda: 2.0, mu: 1.0 };
/// All laws, with the assumption across a plane.
static LAWS: [(Strain, Option<Law>, Plane); 15] = [
    (Strain::Cauchy, None, Plane::Strain),
    (Strain::Cauchy, None, Plane::Stress),
    (Strain::Green, None, Plane::Strain),
    (Strain::Green, Some(Law::NeoHookean), Plane::Strain),
    (Strain::Green, Some(Law::NeoHookean), Plane::Stress),
    (Strain::Green, Some(Law::MooneyRivlin { second: 0.3 }), Plane::Strain),
    (Strain::Green, Some(Law::MooneyRivlin { second: 0.3 }), Plane::Stress),
    (Strain::Green, Some(Law::Yeoh { second: -0.2, third: 0.1 }), Plane::Stress),
    (Strain::Green, Some(OGDEN), Plane::Strain),
    (Strain::Green, Some(OGDEN), Plane::Stress),
    (Strain::Green, Some(Law::own(&MOONEY)), Plane::Strain),
    (Strain::Green, Some(Law::own(&MOONEY)), Plane::Stress),
    (Strain::Green, Some(Law::Corotated), Plane::Strain),
    (Strain::Green, Some(Law::Corotated), Plane::Stress),
    (Strain::Green, None, Plane::Stress),
];

const OGDEN: Law = Law::Ogden { exponents: [1.3, 5.0, -2.0], shares: [0.7, 0.1, 0.2] };

/// Mooney and Rivlin's energy, as a program may write it.
#[derive(Debug)]
struct Mooney {
    first: f64,
    second: f64,
}

static MOONEY: Mooney = Mooney { first: 0.35, second: 0.15 };

impl StrainEnergy for Mooney {
    fn energy<T: DualNum<Primitive = f64> + Copy>(&self, [a, b, c]: [T; 3]) -> T {
        let [a, b, c] = [a * a, b * b, c * c];
        (a + b + c - 3.0) * self.first + (a * b + b * c + c * a - 3.0) * self.second
    }
}

fn law((strain, law, plane): (Strain, Option<Law>, Plane), cell_dimension: usize) -> Elastic {
    Elastic::new(strain, law, LAME, cell_dimension, plane)
}

/// Runs `check::<M, D>` for all cells: strings, membranes and cells that fill space.
macro_rules! in_all_dimensions {
    ($check:ident) => {
        $check::<1, 1>();
        $check::<1, 2>();
        $check::<1, 3>();
        $check::<2, 2>();
        $check::<2, 3>();
        $check::<3, 3>();
    };
}

/// Numbers between -`size` and `size` without a pattern.
fn noise<const R: usize, const C: usize>(size: f64, seed: f64) -> Matrix<f64, R, C> {
    let number = |k: usize| size * (12.9898 * (k as f64 + seed)).sin().mul_add(43.758, 0.3).sin();
    std::array::from_fn(|j| std::array::from_fn(|i| number(R * j + i)))
}

/// An orthonormal frame of a tangent space: the identity where `M == D`, some turned axes otherwise.
fn frame<const M: usize, const D: usize>() -> Matrix<f64, D, M> {
    let mut frame: Matrix<f64, D, M> =
        std::array::from_fn(|j| std::array::from_fn(|i| f64::from(u8::from(i == j))));
    match (M, D) {
        (_, 3) if M < D => frame = rotated(&frame),
        (1, 2) => frame[0][..2].copy_from_slice(&[0.6, 0.8]),
        _ => {}
    }
    frame
}

/// R A, with R a rotation by some angle about a skew axis (about z in the plane, none on a line).
fn rotated<const M: usize, const D: usize>(a: &Matrix<f64, D, M>) -> Matrix<f64, D, M> {
    let rotation = match D {
        1 => Rotation3::identity(),
        2 => Rotation3::new(Vector3::z() * 1.3),
        _ => Rotation3::new(Vector3::new(0.7, -1.1, 0.9)),
    };
    let r: Matrix<f64, D, D> = std::array::from_fn(|j| std::array::from_fn(|i| rotation[(i, j)]));
    product(&r, a)
}

/// `h` with `by` added in row `i`, column `j`.
fn moved<const M: usize, const D: usize>(
    h: &Matrix<f64, D, M>,
    [i, j]: [usize; 2],
    by: f64,
) -> Matrix<f64, D, M> {
    let mut h = *h;
    h[j][i] += by;
    h
}

/// Step of central differences. They are off by the third derivatives of energies and stresses (some
/// ten times the moduli) times its square, 1e-9, and by round-off of 1e-16 over it, 1e-11.
const STEP: f64 = 1e-5;
const OFF: f64 = 1e-8;

fn slope(f: impl Fn(f64) -> f64) -> f64 {
    (f(STEP) - f(-STEP)) / (2.0 * STEP)
}

/// Compares P with `energy`'s derivatives, and a tangent with those of P. The unit vectors as gradients
/// make its blocks dP_ij/dF_kl = block(j, l)[i][k].
fn are_derivatives<const M: usize, const D: usize>(
    name: &str,
    at: &Matrix<f64, D, M>,
    energy: impl Fn(&Matrix<f64, D, M>) -> f64,
    stress: impl Fn(&Matrix<f64, D, M>) -> Matrix<f64, D, M>,
    block: impl Fn(usize, usize) -> [[f64; D]; D],
) {
    for (i, j) in (0..D).flat_map(|i| (0..M).map(move |j| (i, j))) {
        let by_energy = slope(|by| energy(&moved(at, [i, j], by)));
        let apart = (stress(at)[j][i] - by_energy).abs();
        assert!(apart < OFF, "{name} {M} in {D}: P_{i}{j} is off by {apart:e}");
        is_tangent(name, at, &stress, &block, [i, j]);
    }
}

fn is_tangent<const M: usize, const D: usize>(
    name: &str,
    at: &Matrix<f64, D, M>,
    stress: &impl Fn(&Matrix<f64, D, M>) -> Matrix<f64, D, M>,
    block: &impl Fn(usize, usize) -> [[f64; D]; D],
    [i, j]: [usize; 2],
) {
    for (k, l) in (0..D).flat_map(|k| (0..M).map(move |l| (k, l))) {
        let by_stress = slope(|by| stress(&moved(at, [k, l], by))[j][i]);
        let apart = (block(j, l)[i][k] - by_stress).abs();
        assert!(apart < OFF, "{name} {M} in {D}: dP_{i}{j}/dF_{k}{l} is off by {apart:e}");
    }
}

/// A law at a point of a cell.
struct At<'l, L: ElasticLaw, T: Real, const M: usize, const D: usize> {
    law: &'l L,
    deformation: &'l Deformation<T, M, D>,
    point: L::Point<T, M>,
}

fn at<'l, L: ElasticLaw, T: Real, const M: usize, const D: usize>(
    law: &'l L,
    deformation: &'l Deformation<T, M, D>,
) -> At<'l, L, T, M, D> {
    At { law, deformation, point: law.point(L::twice_strain(deformation)) }
}

impl<L: ElasticLaw, T: Real, const M: usize, const D: usize> At<'_, L, T, M, D> {
    fn energy(&self) -> T {
        self.law.energy(&self.point)
    }

    fn domain(&self) -> T {
        self.law.domain(self.deformation.stretch(), &self.point)
    }

    /// P
    fn stress(&self, weight: T) -> Matrix<T, D, M> {
        product(&L::shape(self.deformation), &self.law.stress(&self.point, None, weight))
    }

    fn tangent(self, units: &Matrix<T, M, M>, weight: T) -> impl Blocks<T, D> {
        self.law.tangent(L::shape(self.deformation), self.point, None, units, weight)
    }
}

fn units<const M: usize>() -> Matrix<f64, M, M> {
    std::array::from_fn(|j| std::array::from_fn(|i| f64::from(u8::from(i == j))))
}

/// P = dW/dF and the tangent dP/dF, by central differences.
#[test]
fn stresses_and_tangents_are_derivatives() {
    fn check<const M: usize, const D: usize>() {
        let frame = frame::<M, D>();
        for (strain, seed) in LAWS.into_iter().flat_map(|law| [1.0, 20.0, 300.0].map(|s| (law, s)))
        {
            let h = noise(0.3, seed);
            with_law!(law(strain, M), law => {
                let (units, here) = (units(), Deformation::new(frame, h));
                assert!(at(&law, &here).domain() > 0.0);
                let tangent = at(&law, &here).tangent(&units, 1.0);
                are_derivatives(
                    &format!("{strain:?}"),
                    &h,
                    |h| at(&law, &Deformation::new(frame, *h)).energy(),
                    |h| at(&law, &Deformation::new(frame, *h)).stress(1.0),
                    |a, b| tangent.block(a, b),
                );
            });
        }
    }
    in_all_dimensions!(check);
}

/// The same of objective viscosity: its potential by F' is half of the heat P : F', which is never below 0.
#[test]
fn viscous_stresses_and_tangents_are_derivatives() {
    fn check_law<L: ViscousLaw, const M: usize, const D: usize>(name: &str, law: &L) {
        let (frame, h, rate) = (frame::<M, D>(), noise(0.3, 5.0), noise(1.0, 40.0));
        let (at, units) = (Deformation::new(frame, h), units());
        let by_rate = law.rate_tangent(&at, false, &units, 1.0);
        let heat = |rate: &Matrix<f64, D, M>| {
            let stress = law.stress(&at, rate, None, 1.0);
            stress.iter().zip(rate).map(|(p, rate)| dot(p, rate)).sum::<f64>()
        };
        assert!(heat(&rate) > 0.01, "{name} {M} in {D}: {}", heat(&rate));
        are_derivatives(
            name,
            &rate,
            |rate| 0.5 * heat(rate),
            |rate| law.stress(&at, rate, None, 1.0),
            |a, b| by_rate.block(a, b),
        );
        // at points, and under the pull of a projected dilatation, which is kept constant
        for pull in [None, Some(0.7)] {
            let stress =
                |h: &Matrix<f64, D, M>| law.stress(&Deformation::new(frame, *h), &rate, pull, 1.0);
            let tangent = law.tangent(&at, &rate, pull, &units, 1.0);
            for place in (0..D).flat_map(|i| (0..M).map(move |j| [i, j])) {
                is_tangent(name, &h, &stress, &|a, b| tangent.block(a, b), place);
            }
        }
        // the rate of dilatation by velocities and displacements
        let [by_velocities, by_displacements] = law.swelling(&at, &rate, &units);
        for (i, j) in (0..D).flat_map(|i| (0..M).map(move |j| (i, j))) {
            let own = |by| law.rate_of_dilatation(&at, &moved(&rate, [i, j], by));
            let apart = (by_velocities[j][i] - slope(own)).abs();
            assert!(apart < OFF, "{name} {M} in {D}: dilatation by F' is off by {apart:e}");
            let own = |by| {
                let at = Deformation::new(frame, moved(&h, [i, j], by));
                law.rate_of_dilatation(&at, &rate)
            };
            let apart = (by_displacements[j][i] - slope(own)).abs();
            assert!(apart < OFF, "{name} {M} in {D}: dilatation by F is off by {apart:e}");
        }
    }
    fn check<const M: usize, const D: usize>() {
        let hooke = Hooke::new(LAME, M, Plane::Strain);
        check_law::<_, M, D>("Hookean viscosity", &HookeanViscosity(hooke));
        check_law::<_, M, D>("Newtonian viscosity", &NewtonianViscosity(hooke));
    }
    in_all_dimensions!(check);
}

/// A bar of rubber at the stretch l, which lengthens and keeps its volume, resists with the Kirchhoff stress 3 mu l'/l, a film with
/// 4 mu l'/l along and 2 mu l'/l across where its width is kept, a string with the viscosity itself: whatever Poisson's ratio is, and whether
/// cells grow. Hooke's law for the rate of Green's strain, that of nearly incompressible Hooke's law, is far from that.
#[test]
fn viscosity_of_rubber_does_not_grow_with_stretch() {
    for poisson in [0.4, 0.49, 0.499, 0.499_999] {
        let material = Material { density: 1.0, young: 1.0, poisson, viscosity: 2.0 };
        let mu = material.viscous().mu;
        for l in [0.7_f64, 1.0, 1.5, 2.0] {
            let width = l.powf(-0.5);
            let at = Deformation::new(
                frame::<3, 3>(),
                [[l - 1.0, 0.0, 0.0], [0.0, width - 1.0, 0.0], [0.0, 0.0, width - 1.0]],
            );
            let across = -0.5 * width / l;
            let rate = [[1.0, 0.0, 0.0], [0.0, across, 0.0], [0.0, 0.0, across]];
            let own = |law: &ObjectiveViscosity| match law {
                ObjectiveViscosity::Hookean(law) => law.stress(&at, &rate, None, 1.0),
                ObjectiveViscosity::Newtonian(law) => law.stress(&at, &rate, None, 1.0),
            };
            // the pull along, less that across which a free side takes away; all in Kirchhoff stress
            let pull = |p: Matrix<f64, 3, 3>| p[0][0] * l - p[1][1] * width;
            let rubber = law((Strain::Green, Some(Law::NeoHookean), Plane::Strain), 3);
            let law_of_rubber = ObjectiveViscosity::new(&rubber, &material, 3, Plane::Strain);
            for viscosity in [law_of_rubber, law_of_rubber.of_growing(3)] {
                let p = own(&viscosity);
                assert!((pull(p) * l / (3.0 * mu) - 1.0).abs() < 1e-14, "{poisson} {l}: {p:?}");
                // deviator: the mean pull does not feel lambda, which is 1e6 mu at most
                assert!((p[0][0] * l + 2.0 * p[1][1] * width).abs() < 1e-13, "{poisson} {l}");
            }
            let hooke = law((Strain::Green, None, Plane::Strain), 3);
            let of_hooke = ObjectiveViscosity::new(&hooke, &material, 3, Plane::Strain);
            let explodes = pull(own(&of_hooke)) * l / (3.0 * mu);
            assert!(l != 1.5 || explodes > 1.5, "{poisson}: {explodes}");

            let film = law((Strain::Green, Some(Law::NeoHookean), Plane::Stress), 2);
            let ObjectiveViscosity::Newtonian(film) =
                ObjectiveViscosity::new(&film, &material, 2, Plane::Stress)
            else {
                panic!("rubber is no Hookean material")
            };
            let at = Deformation::new(frame::<2, 3>(), {
                let [along, _] = frame::<2, 3>();
                [along.map(|x| (l - 1.0) * x), [0.0; 3]]
            });
            let [along, across] = frame::<2, 3>();
            let p = film.stress(&at, &[along, [0.0; 3]], None, 1.0);
            // 2 mu + lambda, with the lambda of plane stress: 2 nu mu / (1 - nu)
            let stiff = 2.0 * mu * poisson / (1.0 - poisson);
            let expected = [(stiff + 2.0 * mu) / (l * l), stiff / l];
            let found = [dot(&p[0], &along), dot(&p[1], &across)];
            for (found, expected) in found.iter().zip(expected) {
                assert!((found / expected - 1.0).abs() < 1e-13, "{poisson} {l}: {found}");
            }

            let string = law((Strain::Green, Some(Law::NeoHookean), Plane::Stress), 1);
            let ObjectiveViscosity::Newtonian(string) =
                ObjectiveViscosity::new(&string, &material, 1, Plane::Stress)
            else {
                panic!("rubber is no Hookean material")
            };
            let at = Deformation::new(frame::<1, 1>(), [[l - 1.0]]);
            let [[p]] = string.stress(&at, &[[1.0]], None, 1.0);
            assert!((p * l * l / 2.0 - 1.0).abs() < 1e-14, "{poisson} {l}: {p}");
        }
    }
}

/// Where nothing is deformed, all objective viscosities are Hooke's law with viscous moduli, up to a Poisson's ratio of 0.45;
/// above, a bar that is free across has 0.84 % less of it at most: (1 - 2 nu)/3 - (10/3) (1 - 2 nu)^2.
#[test]
fn viscosity_at_small_strains_is_hookes() {
    let rest = Deformation::new(frame::<3, 3>(), [[0.0; 3]; 3]);
    let rate = noise(1.0, 11.0);
    for poisson in [0.0, 0.3, 0.4, 0.45, 0.46, 0.475, 0.49, 0.4999] {
        let material = Material { density: 1.0, young: 1.0, poisson, viscosity: 1.0 };
        let rubber = law((Strain::Green, Some(Law::NeoHookean), Plane::Strain), 3);
        let ObjectiveViscosity::Newtonian(newtonian) =
            ObjectiveViscosity::new(&rubber, &material, 3, Plane::Strain)
        else {
            panic!("rubber is no Hookean material")
        };
        let hookean = HookeanViscosity(Hooke::new(material.viscous(), 3, Plane::Strain));
        if poisson <= 0.45 {
            let apart = farthest(
                &newtonian.stress(&rest, &rate, None, 1.0),
                &hookean.stress(&rest, &rate, None, 1.0),
            );
            assert!(apart < 1e-14, "{poisson}: {apart:e}");
        }
        // heat of a bar whose sides follow by Poisson's ratio
        let bar = [[1.0, 0.0, 0.0], [0.0, -poisson, 0.0], [0.0, 0.0, -poisson]];
        let p = newtonian.stress(&rest, &bar, None, 1.0);
        let heat = p[0][0] - 2.0 * poisson * p[1][1];
        let least = if poisson <= 0.45 { 1.0 - 1e-14 } else { 0.99166 };
        assert!((least..1.0 + 1e-14).contains(&heat), "{poisson}: {heat}");
    }
}

/// Objective viscosity does not resist a spin, and does so in proportion to its weight where shape changes; a turned
/// body has a turned stress.
fn does_not_brake<L: ViscousLaw, const M: usize, const D: usize>(law: &L) {
    let frame = frame::<M, D>();
    let (at, rate) = (Deformation::new(frame, noise(0.3, 9.0)), noise(1.0, 3.0));
    let f = at.gradient();
    if D > 1 {
        // spinning about an axis: F' = W F with a skew W
        let mut spin = [[0.0; D]; D];
        (spin[0][1], spin[1][0]) = (3.0, -3.0);
        let still = law.stress(&at, &product(&spin, &f), None, 1.0);
        assert!(farthest(&still, &[[0.0; D]; M]) < 1e-13, "{M} in {D}: {still:?}");
    }
    let mut turned = rotated(&f);
    for (turned, frame) in turned.iter_mut().zip(&frame) {
        turned.iter_mut().zip(frame).for_each(|(x, x_0)| *x -= x_0);
    }
    let [some, twice] = [1.0, 2.0].map(|weight| law.stress(&at, &rate, None, weight));
    let after = law.stress(&Deformation::new(frame, turned), &rotated(&rate), None, 1.0);
    assert!(farthest(&after, &rotated(&some)) < 1e-13, "{M} in {D}");
    assert!(farthest(&some, &[[0.0; D]; M]) > 0.1);
    let apart = farthest(&twice, &some.map(|column| column.map(|entry| 2.0 * entry)));
    assert!(apart < 1e-14, "{M} in {D}: {apart:e}");
}

/// Energy does not see a rotation that comes after a deformation, and stress turns with it. Only linear
/// elasticity takes rotations for strains, of the size 1 - cos(angle).
#[test]
fn laws_do_not_see_rotations() {
    fn check<const M: usize, const D: usize>() {
        let frame = frame::<M, D>();
        for strain in LAWS {
            let h = noise(0.3, 9.0);
            let f = Deformation::new(frame, h).gradient();
            let mut turned = rotated(&f);
            for (turned, frame) in turned.iter_mut().zip(&frame) {
                turned.iter_mut().zip(frame).for_each(|(x, x_0)| *x -= x_0);
            }
            let [before, after] = [h, turned].map(|h| Deformation::new(frame, h));
            with_law!(law(strain, M), law => {
                let [before, after] = [&before, &after].map(|shape| at(&law, shape));
                let apart = (after.energy() - before.energy()).abs();
                if strain.0 == Strain::Cauchy && D > 1 {
                    assert!(apart > 1e-2, "linear elasticity, {M} in {D}: {apart:e}");
                    continue;
                }
                // round-off of energies and stresses of size 1
                assert!(apart < 1e-14, "{strain:?} {M} in {D}: energy is off by {apart:e}");
                let expected = rotated(&before.stress(1.0));
                let apart = farthest(&after.stress(1.0), &expected);
                assert!(apart < 1e-14, "{strain:?} {M} in {D}: stress is off by {apart:e}");
            });
        }
        let hooke = Hooke::new(LAME, M, Plane::Strain);
        does_not_brake::<_, M, D>(&HookeanViscosity(hooke));
        does_not_brake::<_, M, D>(&NewtonianViscosity(hooke));
    }
    in_all_dimensions!(check);
}

fn farthest<const R: usize, const C: usize>(a: &Matrix<f64, R, C>, b: &Matrix<f64, R, C>) -> f64 {
    let apart = a.as_flattened().iter().zip(b.as_flattened()).map(|(a, b)| (a - b).abs());
    apart.fold(0.0, f64::max)
}

/// At strains of 1e-7 every law is linear elasticity, to terms of their size: those of the stress are sums of
/// up to nine products of two strains, times moduli.
#[test]
fn laws_are_linear_elasticity_at_small_strains() {
    fn check<const M: usize, const D: usize>() {
        let (frame, size) = (frame::<M, D>(), 1e-7);
        let here = Deformation::new(frame, noise(size, 70.0));
        // the closed form, entry by entry
        let e =
            |j: usize, k: usize| 0.5 * (dot(&frame[j], &here.h[k]) + dot(&frame[k], &here.h[j]));
        let trace: f64 = (0..M).map(|j| e(j, j)).sum();
        for strain in LAWS {
            let linear: Linear = Hookean(Hooke::new(LAME, M, strain.2));
            let Lame { lambda, mu } = linear.0.lame;
            let square: f64 = (0..M)
                .flat_map(|j| (0..M).map(move |k| (j, k)))
                .map(|(j, k)| e(j, k) * e(j, k))
                .sum();
            let s: Matrix<f64, M, M> = std::array::from_fn(|k| {
                std::array::from_fn(|j| {
                    2.0 * mu * e(j, k) + if j == k { lambda * trace } else { 0.0 }
                })
            });
            let (energy, stress) =
                (0.5 * lambda * trace * trace + mu * square, product(&frame, &s));
            with_law!(law(strain, M), law => {
                let apart = at(&law, &here).energy() / energy - 1.0;
                assert!(apart.abs() < 10.0 * size, "{strain:?} {M} in {D}: energy {apart:e}");
                let apart = farthest(&at(&law, &here).stress(1.0), &stress);
                assert!(apart < 20.0 * size * size, "{strain:?} {M} in {D}: stress {apart:e}");
                let rest = Deformation::new(frame, [[0.0; D]; M]);
                let units = units();
                let (own, hooke) = (at(&law, &rest), at(&linear, &rest));
                let (own, hooke) = (own.tangent(&units, 1.0), hooke.tangent(&units, 1.0));
                for (a, b) in (0..M).flat_map(|a| (0..M).map(move |b| (a, b))) {
                    let apart = farthest(&own.block(a, b), &hooke.block(a, b));
                    assert!(apart < 1e-14, "{strain:?} {M} in {D}: tangent {apart:e}");
                }
            });
        }
    }
    in_all_dimensions!(check);
}

/// Simple shear by gamma: the shear stress P_12 in closed form. Rubber: 2 (W1 + W2) gamma at
/// I1 - 3 = gamma^2, and with Ogden's law the sum of mu_p (l^alpha_p - l^-alpha_p) / (l + 1/l) of the
/// stretches l and 1/l, with l - 1/l = gamma.
#[test]
fn simple_shear() {
    let Lame { lambda, mu } = LAME;
    let gamma = 0.8_f64;
    let stretch = 0.5 * gamma + (1.0 + 0.25 * gamma * gamma).sqrt();
    for chosen in LAWS {
        let expected = match chosen {
            (Strain::Cauchy, ..) => mu * gamma,
            (_, None | Some(Law::StVenantKirchhoff), _) => {
                mu * gamma + gamma.powi(3) * (0.5 * lambda + mu)
            }
            (_, Some(Law::NeoHookean | Law::MooneyRivlin { .. } | Law::Own(_)), _) => mu * gamma,
            (_, Some(Law::Yeoh { second, third }), _) => {
                let above = gamma * gamma;
                mu * gamma * (1.0 + 2.0 * second * above + 3.0 * third * above * above)
            }
            (_, Some(Law::Ogden { exponents, shares }), _) => {
                let term = |(a, share): (&f64, &f64)| {
                    2.0 * mu * share / a * (stretch.powf(*a) - stretch.powf(-a))
                };
                exponents.iter().zip(&shares).map(term).sum::<f64>() / (stretch + 1.0 / stretch)
            }
            // turned by tan(angle) = gamma / 2
            (_, Some(Law::Corotated), _) => {
                let longer = stretch + 1.0 / stretch - 2.0;
                let turn = (lambda * longer - 2.0 * mu) * 0.5 * gamma;
                2.0 * mu * gamma + turn / (1.0 + 0.25 * gamma * gamma).sqrt()
            }
        };
        let mut h = [[0.0; 3]; 3];
        h[1][0] = gamma;
        let here = Deformation::new(frame::<3, 3>(), h);
        with_law!(law(chosen, 3), law => {
            let apart = at(&law, &here).stress(1.0)[1][0] - expected;
            assert!(apart.abs() < 1e-14, "{chosen:?}: {apart:e}");
        });
    }
}

/// Laws at the points of as many cells as a register of the machine holds.
struct AtOnce<const M: usize, const D: usize>;

impl<const M: usize, const D: usize> WithSimd for AtOnce<M, D> {
    type Output = ();

    fn with_simd<S: Simd>(self, simd: S) {
        let frame = frame::<M, D>();
        let mut points: [Matrix<f64, D, M>; SIDE_BY_SIDE] =
            std::array::from_fn(|lane| noise(0.3, 11.0 + 39.0 * lane as f64));
        points[1][0] = std::array::from_fn(|i| points[1][0][i] - 3.0 * frame[0][i]);
        let volumes: [f64; SIDE_BY_SIDE] = std::array::from_fn(|lane| 0.3 + 0.1 * lane as f64);
        for part in 0..SIDE_BY_SIDE / S::F64_LANES {
            let load = |number: &dyn Fn(usize) -> f64| {
                Lane::load(simd, &std::array::from_fn::<_, SIDE_BY_SIDE, _>(number), part)
            };
            let h: Matrix<Lane<S>, D, M> =
                std::array::from_fn(|j| std::array::from_fn(|i| load(&|lane| points[lane][j][i])));
            let frames = frame.map(|column| column.map(|entry| load(&|_| entry)));
            let (here, volume) = (Deformation::new(frames, h), load(&|lane| volumes[lane]));
            let numbers = |lanes: Lane<S>| {
                let mut numbers = [0.0; SIDE_BY_SIDE];
                lanes.store(&mut numbers, 0);
                numbers
            };
            for strain in LAWS {
                with_law!(law(strain, M), law => {
                    let all = at(&law, &here);
                    let energy = numbers(all.energy());
                    let domain = numbers(all.domain());
                    let stress = all.stress(volume).map(|column| column.map(numbers));
                    for lane in 0..S::F64_LANES {
                        let k = part * S::F64_LANES + lane;
                        let one = Deformation::new(frame, points[k]);
                        let one = at(&law, &one);
                        assert_eq!(energy[lane], one.energy());
                        assert_eq!(domain[lane], one.domain());
                        let own = stress.map(|column| column.map(|entry| entry[lane]));
                        assert_eq!(own, one.stress(volumes[k]), "{strain:?} {M} in {D}");
                    }
                    let inside = (0..S::F64_LANES).all(|lane| domain[lane] > 0.0);
                    assert_eq!(all.domain().are_positive(), inside);
                });
            }
        }
    }
}

/// Laws are the same formula over any number: several points at once, bit for bit as one after the other,
/// one of them outside the domain.
#[test]
fn several_points_at_once() {
    fn check<const M: usize, const D: usize>() {
        at_once(AtOnce::<M, D>);
        AtOnce::<M, D>.with_simd(Scalar);
    }
    in_all_dimensions!(check);
}

/// The message for a cell that is turned inside out, and the number that detects it.
#[test]
fn what_is_inverted_is_outside_the_domain() {
    let frame = units::<2>();
    let law: StVenantKirchhoff = Hookean(Hooke::new(LAME, 2, Plane::Strain));
    let turned = Deformation::new(frame, [[-1.5, 0.0], [0.0, 0.0]]);
    assert_eq!(at(&law, &turned).domain(), -0.5);
    assert!(law.outside(-0.5).starts_with("is inverted, det F = -0.500: St. Venant-Kirchhoff"));
}
