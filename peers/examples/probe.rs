use pliant::*;
use pliant_peers::scenes::Case;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let lumped = a[2] == "l";
    let scene = Case::find(&a[1])
        .unwrap()
        .scene(if lumped { Inertia::Lumped } else { Inertia::Consistent })
        .unwrap();
    let solver = Solver {
        method: a[3].parse().unwrap(),
        rtol: a[4].parse().unwrap(),
        max_order: a.get(6).map(|x| x.parse().unwrap()),
        ..Solver::default()
    };
    for _ in 0..a[5].parse::<usize>().unwrap() {
        let t = scene.simulate(&solver, &Sampling::every(0.02)).unwrap();
        println!("{} {}", t.report().wall_seconds, t.report().steps());
    }
}
