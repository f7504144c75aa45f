//! Liquids that fill their chamber against their own derivatives, and against the weight that they have.

use std::sync::Arc;

use super::{Liquid, LiquidInChamber, Weight};
use crate::base::sparse::BlockMatrix;
use crate::base::vector::dot;
use crate::elements::body::Body;
use crate::elements::force::{Force, NodalForces};
use crate::elements::material::Material;
use crate::elements::mesh::{CellKind, Cells, Mesh, Selection, SolidCells};
use crate::scene::forces::Chamber;
use crate::scene::forces::chamber_fluid::{ChamberFluid, Fill};
use crate::scene::forces::fixed_amount::FixedAmount;

/// Strong gravity, and a liquid that is light to compress, so that nothing is round-off.
const GRAVITY: f64 = 400.0;
const BULK: f64 = 1e5;

/// A liquid in the middle of a square or a cube of 3 cells along each side, which are of second order, and displacements under which all is curved.
fn poured(dimension: usize, gravity: f64) -> (Body, LiquidInChamber, Vec<f64>) {
    let material = Material { density: 1000.0, young: 1e6, poisson: 0.3, viscosity: 0.0 };
    let (mesh, kind) = match dimension {
        2 => {
            (Mesh::rectangle([0.3; 2], [4; 2], Cells::Rectangles).unwrap(), CellKind::Quadrilateral)
        }
        _ => {
            let cells = SolidCells::Hexahedra;
            (Mesh::cuboid([0.3; 3], [4; 3], cells).unwrap(), CellKind::Hexahedron)
        }
    };
    let middle = 3_usize.pow(dimension as u32) / 2;
    let around = mesh.cells().enumerate().filter(|(number, _)| *number != middle);
    let around = around.flat_map(|(_, cell)| cell.to_vec()).collect();
    let mesh = Mesh::new(dimension, mesh.positions().to_vec(), kind, around).unwrap();
    let body = Body::new(mesh.quadratic().unwrap(), material);
    let body = if dimension == 2 { body.thickness(0.7) } else { body };
    let body = body.build().unwrap();
    let [min, max] = [0.1 - 1e-9, 0.2 + 1e-9].map(|corner| vec![corner; dimension]);
    let chamber = Chamber::within("bag", Selection::Box { min, max });
    let walls = chamber.force(&body, Vec::new()).unwrap();
    let moment = chamber.moment(&body, &walls, DOWN[dimension - 2]).unwrap();
    let liquid = Liquid::in_chamber("bag").bulk_modulus(BULK).density(900.0).fill(1.05);
    let weight = match gravity > 0.0 {
        true => Weight::Whole { moment, gravity },
        false => Weight::None,
    };
    let poured = liquid.pour(walls, body.dofs(), weight, vec![1e-3.into()]).unwrap();
    let bent = |k: usize| 0.01 * (1.3 * k as f64).sin();
    let u = (0..body.dofs()).map(bent).collect();
    (body, poured, u)
}

/// Directions of gravity in the plane and in space.
const DOWN: [[f64; 3]; 2] = [[0.6, -0.8, 0.0], [0.48, 0.36, -0.8]];

fn forces(liquid: &LiquidInChamber, u: &[f64], amount: f64) -> Vec<f64> {
    let mut forces = NodalForces::zeros(u.len());
    liquid.press(u, Fill::of(amount), &mut forces).unwrap();
    forces.conservative.to_vec()
}

/// Forces are the derivative of the energy, and what flows in brings that by the amount; the tangent is that of the forces but for the part that is said
/// to be left out.
#[test]
fn forces_and_tangents_belong_to_the_energy() {
    for dimension in [2, 3] {
        let (body, liquid, u) = poured(dimension, GRAVITY);
        let amount = 1.02 * liquid.amount();
        let by = |k: usize, apart: f64| {
            let mut u = u.clone();
            u[k] += apart;
            u
        };
        let found = forces(&liquid, &u, amount);
        let largest = found.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        let apart = 1e-5;
        for (k, force) in found.iter().enumerate() {
            let [ahead, behind] =
                [apart, -apart].map(|x| liquid.potential(&by(k, x), Fill::of(amount)));
            let difference = (behind - ahead) / (2.0 * apart);
            assert!((force - difference).abs() < 1e-7 * largest, "{k}: {} {difference}", force);
        }
        let more = 1e-5 * amount;
        let [ahead, behind] = [more, -more].map(|x| liquid.potential(&u, Fill::of(amount + x)));
        let [brought, slope] = liquid.brought(&u, amount).unwrap();
        let difference = (ahead - behind) / (2.0 * more);
        assert!((brought / difference - 1.0).abs() < 1e-8, "{brought} {difference}");
        let [ahead, behind] = [more, -more].map(|x| liquid.brought(&u, amount + x).unwrap()[0]);
        assert!((slope / ((ahead - behind) / (2.0 * more)) - 1.0).abs() < 1e-8, "{slope}");
        let amount = liquid.amount();
        let (volume, heavy) = (liquid.walls().volume(&u), forces(&liquid, &u, amount));
        let amount = liquid.amount();
        let closed = FixedAmount::new(liquid, amount, u.len());
        let pattern = Arc::new(body.inertia().pattern().with_pairs(&closed.couplings()));
        let [mut stiffness, mut damping] =
            [(), ()].map(|()| BlockMatrix::zeros(&pattern, dimension));
        closed.add_tangents(0.0, &u, &[], &mut stiffness, &mut damping);
        let (_, light, _) = poured(dimension, 0.0);
        let (_, liquid, _) = poured(dimension, GRAVITY);
        let weight: Vec<f64> =
            heavy.iter().zip(forces(&light, &u, amount)).map(|(a, b)| a - b).collect();
        let left_out = liquid.natural(amount) / (BULK * volume * volume);
        let (mut worst, mut most, mut column) = (0.0_f64, 0.0_f64, vec![0.0; u.len()]);
        for k in 0..u.len() {
            let unit: Vec<f64> = (0..u.len()).map(|j| f64::from(j == k)).collect();
            stiffness.product(&unit, &mut column);
            let [ahead, behind] = [apart, -apart].map(|x| forces(&liquid, &by(k, x), amount));
            for (row, tangent) in column.iter().enumerate() {
                let difference = (behind[row] - ahead[row]) / (2.0 * apart);
                let whole = tangent - left_out * weight[row] * weight[k];
                worst = worst.max((whole - difference).abs());
                most = most.max(difference.abs());
            }
        }
        println!("{dimension}: tangents apart by {:e}", worst / most);
        assert!(worst < 1e-8 * most, "{dimension}: {worst:e} {most:e}");
    }
}

/// Whatever its shape, its forces add up to its weight, which acts in its middle; and they do not change with the place where it is.
#[test]
fn forces_are_the_weight_in_the_middle() {
    for dimension in [2, 3] {
        let (_, liquid, u) = poured(dimension, GRAVITY);
        let amount = liquid.amount();
        let found = forces(&liquid, &u, amount);
        let down = DOWN[dimension - 2];
        for (axis, down) in down.iter().enumerate().take(dimension) {
            let sum: f64 = found.iter().skip(axis).step_by(dimension).sum();
            let weight = amount * GRAVITY * down;
            assert!((sum - weight).abs() < 1e-11 * amount * GRAVITY, "{axis}: {sum} {weight}");
        }
        // lifting it against gravity costs the weight
        let up = 0.5;
        let far: Vec<f64> =
            u.iter().enumerate().map(|(k, u)| u - up * down[k % dimension]).collect();
        let lifted =
            liquid.potential(&far, Fill::of(amount)) - liquid.potential(&u, Fill::of(amount));
        assert!((lifted / (amount * GRAVITY * up) - 1.0).abs() < 1e-11, "{lifted}");
        let there = forces(&liquid, &far, amount);
        let size = dot(&found, &found).sqrt();
        let apart = found.iter().zip(&there).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
        println!("{dimension}: forces change by {:e} along 0.5 m", apart / size);
        assert!(apart < 2e-13 * size, "{apart:e} {size:e}");
    }
}
