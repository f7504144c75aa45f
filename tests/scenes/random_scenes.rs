//! Random scenes: what `auto` computes at rtol 1e-4 lies near what two other families of integrators
//! agree on at fine tolerances, or a warning says that it may not.
//!
//! The first seeds run with all tests. More of them, in a release build:
//! `PLIANT_SEEDS=0..300 cargo test --release --test scenes random_scenes -- --nocapture`

use pliant::{
    Body, Cells, Inertia, Material, Mesh, Method, Obstacle, Phase, Sampling, Scene, Settings,
    SolidCells, Strain, Trajectory,
};

/// Part of the motion by which `auto` may be off without a warning, and by which the two references
/// may lie apart.
const OFF: f64 = 0.2;
const APART: f64 = 0.02;

/// Random numbers: splitmix64.
struct Random(u64);

impl Random {
    /// Between 0 and 1.
    fn part(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.part()
    }

    /// Evenly on a logarithmic scale.
    fn scale(&mut self, low: f64, high: f64) -> f64 {
        low * (high / low).powf(self.part())
    }

    fn below(&mut self, count: usize) -> usize {
        (self.part() * count as f64) as usize
    }

    fn is(&mut self, probability: f64) -> bool {
        self.part() < probability
    }

    /// A vector with components of either sign, no larger than `size`.
    fn vector(&mut self, dimension: usize, size: f64) -> Vec<f64> {
        (0..dimension).map(|_| self.between(-size, size)).collect()
    }
}

fn body(random: &mut Random) -> (Body, usize) {
    let dimension = [1, 2, 2, 2, 2, 3][random.below(6)];
    let size = random.between(0.03, 0.1);
    let mesh = match dimension {
        1 => Mesh::bar(size, 2 + random.below(5)),
        2 => {
            let cells = [Cells::Triangles, Cells::Rectangles, Cells::Triangles6][random.below(3)];
            let nodes = [3 + random.below(2), 3 + random.below(2)];
            Mesh::rectangle([size, random.between(0.5, 1.0) * size], nodes, cells)
        }
        _ => {
            let cells = [SolidCells::Tetrahedra, SolidCells::Hexahedra][random.below(2)];
            Mesh::cuboid([size; 3], [2; 3], cells)
        }
    };
    let material = Material {
        density: 1000.0,
        young: random.scale(1e5, 1e6),
        poisson: random.between(0.0, 0.45),
        viscosity: [0.0, random.scale(1.0, 1e3)][random.below(2)],
    };
    let mut body = Body::new(mesh.unwrap(), material).strain(Strain::Cauchy);
    body = match dimension {
        1 => body.area(1e-4),
        2 => body.thickness(0.01),
        _ => body,
    };
    // cells in one dimension turn inside out with Green strain where a block would not
    if dimension > 1 && random.is(0.4) {
        body = body.strain(Strain::Green);
    }
    if random.is(0.3) {
        body = body.inertia(Inertia::Lumped);
    }
    (body.build().unwrap(), dimension)
}

/// A floor, or something small or moving on the way down.
fn obstacle(random: &mut Random, dimension: usize, fall: f64) -> Obstacle {
    let below = |random: &mut Random, size: f64, depth: f64| {
        let mut place = random.vector(dimension, size);
        place[dimension - 1] = -depth;
        place
    };
    let mut up = vec![0.0; dimension];
    up[dimension - 1] = 1.0;
    let mut obstacle = match random.below(4) {
        0 => Obstacle::half_plane(below(random, 0.1, fall), up),
        1 => {
            let thickness = random.between(0.004, 0.02);
            let (mut min, mut max) = (vec![-0.3; dimension], vec![0.3; dimension]);
            (min[dimension - 1], max[dimension - 1]) = (-fall - thickness, -fall);
            Obstacle::box_between(min, max)
        }
        2 => {
            let radius = random.between(0.01, 0.05);
            Obstacle::disc(below(random, 0.02, fall + radius), radius)
        }
        _ => {
            let radius = random.between(0.01, 0.03);
            let speed = random.between(1.0, 20.0);
            up.iter_mut().for_each(|x| *x *= speed);
            Obstacle::disc(below(random, 0.01, fall + radius), radius).velocity(up)
        }
    };
    obstacle = obstacle
        .named(format!("obstacle {}", random.below(1_000_000)))
        .stiffness(random.scale(1e3, 1e5))
        .adhesion(random.is(0.5));
    if random.is(0.5) {
        obstacle = obstacle.damping(random.scale(0.1, 10.0));
    }
    if random.is(0.5) {
        obstacle = obstacle.tangential_damping(random.scale(0.1, 10.0));
    }
    obstacle
}

/// The scene of one seed.
fn scene(seed: u64) -> Scene {
    let mut random = Random(seed);
    let (body, dimension) = body(&mut random);
    let (down, fall) = (random.between(0.0, 10.0), random.scale(0.01, 2.0));
    let mut velocity = random.vector(dimension, 0.3);
    velocity[dimension - 1] -= down;
    let mut scene = Scene::new(body);
    if random.is(0.7) {
        let mut gravity = vec![0.0; dimension];
        gravity[dimension - 1] = -9.8;
        scene = scene.gravity(gravity);
    }
    for _ in 0..1 + random.below(2) {
        scene = scene.obstacle(obstacle(&mut random, dimension, fall));
    }
    // as long again as the way down takes, and a tenth of a second
    let arrival = fall / down.max((2.0 * 9.8 * fall).sqrt() / 2.0).max(0.5);
    let end = f64::min(2.0 * arrival + 0.1, 1.0);
    if random.is(0.25) {
        // held by its highest nodes, shaken, and let go
        let side = ["right", "top", "top"][dimension - 1];
        let hold = Phase::until(0.05).move_nodes(side, random.vector(dimension, 0.1));
        return scene.phase(hold.named("held")).phase(Phase::until(0.05 + end));
    }
    scene.initial_velocity(move |_| velocity.clone()).phase(Phase::until(end))
}

/// Largest distance between displacements at the same times, and the largest displacement (m).
fn apart(a: &Trajectory, b: &Trajectory) -> (f64, f64) {
    let (mut apart, mut motion) = (0.0_f64, 0.0_f64);
    for (a, b) in a.samples().iter().zip(b.samples()) {
        for (a, b) in a.u.iter().zip(&b.u) {
            apart = apart.max((a - b).abs());
            motion = motion.max(b.abs());
        }
    }
    (apart, motion)
}

/// What became of a seed.
#[derive(Debug, PartialEq)]
enum Verdict {
    Good,
    /// `auto` said that it failed, or may be wrong.
    Said(String),
    /// The references failed, and `auto` did, too, or gave a warning.
    NoReference(String),
    Wrong(String),
}

/// What is doubtful in the integration, not in the scene.
fn doubts(motion: &Trajectory) -> Vec<String> {
    let report = motion.report();
    let mut warnings = report.warnings();
    warnings.retain(|warning| !report.doubts().contains(warning));
    warnings
}

fn verdict(seed: u64) -> Verdict {
    let scene = scene(seed);
    let run = |method, rtol| {
        let settings = Settings { method, rtol, max_steps: 200_000, ..Settings::default() };
        scene.simulate(&settings, &Sampling::every(0.25 * scene.end()))
    };
    let references = match (run(Method::CvodeAdams, 1e-8), run(Method::Ida, 1e-6)) {
        (Ok(a), Ok(b)) => [a, b],
        (Err(error), Err(_)) => {
            return match run(Method::Auto, 1e-4) {
                Ok(motion) if doubts(&motion).is_empty() => {
                    Verdict::Wrong(format!("auto goes on where both references end: {error}"))
                }
                _ => Verdict::NoReference(error.to_string()),
            };
        }
        (Err(error), _) | (_, Err(error)) => {
            return Verdict::Wrong(format!("only one reference ends: {error}"));
        }
    };
    let (off, motion) = apart(&references[1], &references[0]);
    if off > APART * motion {
        return Verdict::Wrong(format!("the references lie apart by {:.1e}", off / motion));
    }
    let motion_of_auto = match run(Method::Auto, 1e-4) {
        Ok(motion) => motion,
        Err(error) => return Verdict::Said(error.to_string()),
    };
    let (off, motion) = apart(&motion_of_auto, &references[0]);
    let warnings = doubts(&motion_of_auto);
    match off > OFF * motion {
        false => Verdict::Good,
        true if !warnings.is_empty() => Verdict::Said(warnings.join("; ")),
        true => Verdict::Wrong(format!("auto is off by {:.1e}", off / motion)),
    }
}

#[test]
fn auto_is_right_or_says_that_it_may_not_be() {
    let seeds = match std::env::var("PLIANT_SEEDS") {
        Err(_) => 0..30,
        Ok(range) => {
            let (from, to) = range.split_once("..").expect("PLIANT_SEEDS=FROM..TO");
            from.parse().expect("a whole number")..to.parse().expect("a whole number")
        }
    };
    let (count, mut bad) = (seeds.clone().count(), Vec::new());
    let (mut said, mut without) = (0, 0);
    for seed in seeds {
        match verdict(seed) {
            Verdict::Good => {}
            Verdict::Said(what) => {
                said += 1;
                println!("seed {seed}: said: {what}");
            }
            Verdict::NoReference(why) => {
                without += 1;
                println!("seed {seed}: no reference: {why}");
            }
            Verdict::Wrong(how) => {
                println!("seed {seed}: {how}");
                bad.push(seed);
            }
        }
    }
    println!("{count} scenes, {said} with a warning, {without} without a reference, bad: {bad:?}");
    assert!(bad.is_empty(), "seeds {bad:?}");
    // scenes that cannot be judged must not be what the test consists of
    assert!(10 * without <= count, "{without} of {count} without a reference");
}
