//! Counted cases: small meshes, each operation by itself.

use std::error::Error;
use std::path::Path;

use pliant::ode::Failure;
use pliant::{
    Body, Cells, Dilatation, Equations, Fibres, Inertia, InputError, Law, Material, Mesh, Method,
    Obstacle, Phase, Scene, SceneFile, Settings, SolidCells, Strain, Substance,
};

pub type Outcome<T = ()> = Result<T, Box<dyn Error>>;

/// Takes the name of a case, what its instructions are divided by, how many of that there are, and the work, which
/// is done several times.
pub type Count<'a> = &'a mut dyn FnMut(&str, &str, usize, &mut dyn FnMut() -> Outcome) -> Outcome;

/// Steps of each method that are counted, and as many before, in which step sizes settle.
const STEPS: usize = 64;
/// Step parameter (s) of Newton matrices.
const GAMMA: f64 = 1e-3;
const RUBBER: Material = Material { density: 1000.0, young: 1e5, poisson: 0.3, viscosity: 0.0 };

/// Counts all cases.
pub fn run(count: Count) -> Outcome {
    cells(count)?;
    matrices(count)?;
    steps(count)?;
    scenes(count)
}

/// Forces and tangents of each kind of cell.
fn cells(count: Count) -> Outcome {
    let plane = |cells| Mesh::rectangle([0.16, 0.02], [17, 3], cells);
    let space = |cells| Mesh::cuboid([0.08, 0.02, 0.02], [9, 3, 3], cells);
    let triangles = || plane(Cells::Triangles);
    let green = |mesh| scene(mesh, RUBBER, Strain::Green);
    let viscous = Material { viscosity: 10.0, ..RUBBER };
    let floor = Obstacle::half_plane([0.0, 1e-5], [0.0, 1.0]).stiffness(100.0);
    let scenes = [
        ("segments", green(Mesh::bar(0.16, 65)?)?),
        ("triangles", green(triangles()?)?),
        ("triangles of 6 nodes", green(plane(Cells::Triangles6)?)?),
        ("quadrilaterals", green(plane(Cells::Rectangles)?)?),
        ("tetrahedra", green(space(SolidCells::Tetrahedra)?)?),
        ("tetrahedra of 10 nodes", green(space(SolidCells::Tetrahedra10)?)?),
        ("hexahedra", green(space(SolidCells::Hexahedra)?)?),
        ("hexahedra of 20 nodes", green(space(SolidCells::Hexahedra20)?)?),
        ("triangles, viscous", scene(triangles()?, viscous, Strain::Green)?),
        ("triangles on a floor", green(triangles()?)?.obstacle(floor.friction_coefficient(0.3))),
    ];
    let rubber = |substance: Substance, dilatation| {
        let body = Body::new(space(SolidCells::Hexahedra)?, substance);
        let held = Phase::until(10.0).hold("left");
        Ok::<_, InputError>(Scene::new(body.dilatation(dilatation).build()?).phase(held))
    };
    let neo_hookean = RUBBER.law(Law::NeoHookean);
    let ogden = Law::Ogden { exponents: [1.3, 5.0, -2.0], shares: [0.97, 0.01, 0.02] };
    let threads = Fibres::along([1.0, 0.0, 0.0], 1e6);
    let of_rubber = [
        ("hexahedra, neo-Hookean", rubber(neo_hookean.clone(), Dilatation::AtPoints)?),
        ("hexahedra, neo-Hookean, mean dilatation", rubber(neo_hookean, Dilatation::Mean)?),
        ("hexahedra, Ogden", rubber(RUBBER.law(ogden), Dilatation::AtPoints)?),
        ("hexahedra, corotated", rubber(RUBBER.law(Law::Corotated), Dilatation::AtPoints)?),
        ("hexahedra with fibres", rubber(RUBBER.fibres(threads), Dilatation::AtPoints)?),
    ];
    for (name, scene) in scenes.into_iter().chain(of_rubber) {
        let cells = scene.body().mesh().cells().count();
        let mut case = Case::new(&scene)?;
        count(&format!("forces, {name}"), "cell", cells, &mut || case.forces())?;
        count(&format!("tangents, {name}"), "cell", cells, &mut || case.tangents())?;
    }
    let linear = scene(triangles()?, RUBBER, Strain::Cauchy)?;
    let cells = linear.body().mesh().cells().count();
    let mut case = Case::new(&linear)?;
    count("forces, triangles, linear", "cell", cells, &mut || case.forces())
}

/// Newton matrices in the plane and in space.
fn matrices(count: Count) -> Outcome {
    let meshes = [
        ("plane", Mesh::rectangle([0.34, 0.04], [69, 9], Cells::Triangles)?),
        ("space", Mesh::cuboid([0.08, 0.04, 0.04], [9, 5, 5], SolidCells::Hexahedra)?),
    ];
    for (name, mesh) in meshes {
        let mut case = Case::new(&scene(mesh, RUBBER, Strain::Green)?)?;
        let dofs = case.u.len();
        case.tangents()?;
        count(&format!("factorization, {name}"), "component", dofs, &mut || case.factorize())?;
        count(&format!("solution, {name}"), "component", dofs, &mut || case.solve())?;
    }
    Ok(())
}

/// Steps of a beam that swings.
fn steps(count: Count) -> Outcome {
    let methods =
        [Method::CentralDifference, Method::Rk, Method::CvodeBdf, Method::Ida, Method::Arkode];
    for method in methods {
        let settings = Settings { method, ..Settings::default() };
        let mut simulation = swinging(method)?.start(&settings)?;
        count(&format!("step, {method}"), "step", STEPS, &mut || {
            Ok((0..STEPS).try_for_each(|_| simulation.step().map(drop))?)
        })?;
    }
    Ok(())
}

/// Operations done once per run, or per sample.
fn scenes(count: Count) -> Outcome {
    let scene = swinging(Method::Arkode)?;
    let settings = Settings { method: Method::Arkode, ..Settings::default() };
    let nodes = scene.body().mesh().node_count();
    let mut simulation = scene.start(&settings)?;
    simulation.step()?;
    count("sample", "node", nodes, &mut || Ok(simulation.sample().map(drop)?))?;
    count("start of a run", "node", nodes, &mut || Ok(scene.start(&settings).map(drop)?))?;
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/ring-jump.toml");
    let text = std::fs::read_to_string(&path)?;
    count("reading of a scene", "byte", text.len(), &mut || {
        Ok(SceneFile::parse(&text, &path).map(drop)?)
    })
}

fn scene(mesh: Mesh, material: Material, strain: Strain) -> Result<Scene, InputError> {
    let body = match mesh.dimension() {
        1 => Body::new(mesh, material).area(1e-4),
        2 => Body::new(mesh, material).thickness(0.01),
        _ => Body::new(mesh, material),
    };
    let body = body.strain(strain).build()?;
    Ok(Scene::new(body).phase(Phase::until(10.0).hold("left")))
}

/// A beam that is let go under gravity, with the inertia that the method wants.
fn swinging(method: Method) -> Result<Scene, InputError> {
    let inertia = match method {
        Method::CentralDifference => Inertia::Lumped,
        _ => Inertia::Consistent,
    };
    let mesh = Mesh::rectangle([0.35, 0.02], [36, 3], Cells::Triangles)?;
    let body = Body::new(mesh, Material { viscosity: 40.0, ..RUBBER }).thickness(0.01);
    let body = body.inertia(inertia).build()?;
    Ok(Scene::new(body).gravity([0.0, -2.0]).phase(Phase::until(10.0).hold("left")))
}

/// Equations at a state that is neither at rest nor straight.
struct Case {
    equations: Equations,
    u: Vec<f64>,
    v: Vec<f64>,
    f: Vec<f64>,
}

impl Case {
    fn new(scene: &Scene) -> Result<Self, InputError> {
        let rest = vec![0.0; scene.body().dofs()];
        let small = |scale: f64| (0..rest.len()).map(|i| scale * (i as f64).sin()).collect();
        let equations = scene.equations(0, &rest)?;
        Ok(Self { equations, u: small(1e-5), v: small(1e-3), f: rest })
    }

    fn forces(&mut self) -> Outcome {
        told(self.equations.forces(0.0, &self.u, &self.v, &mut self.f))
    }

    fn tangents(&mut self) -> Outcome {
        self.equations.tangents(0.0, &self.u, &self.v);
        Ok(())
    }

    fn factorize(&mut self) -> Outcome {
        told(self.equations.factorize(GAMMA))
    }

    fn solve(&mut self) -> Outcome {
        // two vectors that the next solution begins with
        let (mut ru, mut rv) = (self.u.clone(), self.v.clone());
        self.equations.solve(&mut ru, &mut rv);
        Ok(())
    }
}

fn told(result: Result<(), Failure>) -> Outcome {
    result.map_err(|failure| format!("{failure:?}").into())
}
