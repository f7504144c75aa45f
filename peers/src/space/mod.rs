//! A block in space by pliant, dolfinx and CalculiX, each with cells of its own: errors of mesh and time together.

mod problem;

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

use pliant::study::{Failed, Findings, Study, time_text};
use pliant::{Body, InputError, Material, Mesh, Phase, Scene, SolidCells, Strain};

use crate::comparison::TOO_SLOW;
use crate::external::Program;
use crate::{here, report};
use problem::{Fineness, Space, Way};
pub use problem::{extrapolated, order};

/// Processor time (s) that a run may take, in full and quickly.
const LIMITS: [f64; 2] = [20.0, 3.0];
/// Errors, as parts of the motion, at which lines are compared.
const ACCURACIES: [f64; 5] = [0.3, 0.2, 0.1, 0.05, 0.035];

/// A block that is clamped at one end and let go under gravity.
pub struct Block {
    pub name: &'static str,
    pub title: &'static str,
    pub material: Material,
}

/// Size (m), gravity (m/s^2) and end (s).
pub const SIZE: [f64; 3] = [0.1, 0.03, 0.03];
pub const GRAVITY: f64 = 9.8;
pub const END: f64 = 0.5;

const RUBBER: Material = Material { density: 1000.0, young: 1e5, poisson: 0.4, viscosity: 0.0 };

const BLOCKS: [Block; 2] = [
    Block { name: "block", title: "Clamped block in space, undamped", material: RUBBER },
    Block {
        name: "block-damped",
        title: "Clamped block in space, damped",
        material: Material { viscosity: 200.0, ..RUBBER },
    },
];

impl Block {
    /// Its scene, with this number of grid cells across and three times as many along.
    pub fn scene(&self, cells: SolidCells, across: usize) -> Result<Scene, InputError> {
        let nodes = [3 * across + 1, across + 1, across + 1];
        let mesh = Mesh::cuboid(SIZE, nodes, cells)?;
        let body = Body::new(mesh, self.material).strain(Strain::Green);
        Ok(Scene::new(body.build()?)
            .gravity([0.0, 0.0, -GRAVITY])
            .phase(Phase::until(END).named("swings").hold("left")))
    }
}

/// # Errors
/// Arguments that are wrong, files that cannot be written.
pub fn run(words: &[String]) -> Result<(), Failed> {
    let (mut quick, mut out, mut blocks) = (false, PathBuf::from("out"), Vec::new());
    let mut words = words.iter().map(String::as_str);
    while let Some(word) = words.next() {
        match word {
            "--quick" => quick = true,
            "--out" => out = words.next().ok_or("--out needs a folder")?.into(),
            name => match BLOCKS.iter().find(|block| block.name == name) {
                Some(block) => blocks.push(block),
                None => {
                    let known = BLOCKS.map(|block| block.name).join(", ");
                    return Err(format!("no case {name}: there are {known}").into());
                }
            },
        }
    }
    if blocks.is_empty() {
        blocks = BLOCKS.iter().take(if quick { 1 } else { 2 }).collect();
    }
    fs::create_dir_all(&out)?;
    for block in blocks {
        let mut space = Space::new(block, &out, quick);
        add_lines(&mut space, block, quick);
        let limit = LIMITS[usize::from(quick)];
        // patience: a slow peer is told by its limit alone
        let study = Study::new(&mut space).repetitions(1).limit(limit).patience(1e6);
        let findings = study.run(&mut |stage| eprintln!("{}: {stage}", block.name))?;
        write(&out, block, &findings)?;
    }
    Ok(())
}

fn add_lines(space: &mut Space, block: &Block, quick: bool) {
    let mut line = |name: &str, family: &str, way: Way, finenesses: &[(usize, f64)]| {
        let kept = if quick { &finenesses[..2] } else { finenesses };
        let kept = kept.iter().map(|&(across, setting)| Fineness { across, setting });
        space.line(name, family, way, kept.collect());
    };
    let pliant = [
        ("pliant, 10-node tetrahedra", SolidCells::Tetrahedra10),
        ("pliant, hexahedra", SolidCells::Hexahedra),
        ("pliant, tetrahedra", SolidCells::Tetrahedra),
    ];
    for (name, cells) in pliant {
        let meshes: &[(usize, f64)] = match cells {
            SolidCells::Tetrahedra10 => &[(1, 1e-2), (2, 1e-3), (3, 1e-3), (4, 1e-3)],
            _ => &[(2, 1e-2), (4, 1e-3), (6, 1e-3), (8, 1e-3)],
        };
        line(name, "pliant", Way::Pliant(cells), meshes);
    }
    let python = "/usr/bin/python3".to_owned();
    let program = |command: Vec<String>, method| Program { command, method, patience: 1.0 };
    let dolfinx = vec![python, here(&["dolfinx/solve.py"]).remove(0)];
    let quadratic: &[(usize, f64)] = &[(2, 100.0), (2, 200.0), (3, 200.0), (4, 200.0)];
    let linear: &[(usize, f64)] = &[(2, 100.0), (4, 100.0), (6, 100.0), (8, 200.0)];
    line("dolfinx P2", "dolfinx", Way::Program(program(dolfinx.clone(), "P2")), quadratic);
    line("dolfinx P1", "dolfinx", Way::Program(program(dolfinx, "P1")), linear);
    if block.material.viscosity > 0.0 {
        // CalculiX has no such viscosity
        return;
    }
    let calculix = here(&[".venv/bin/python", "calculix/solve.py"]);
    // without a node in the middle of a face
    let even: &[(usize, f64)] = &[(2, 100.0), (2, 200.0), (4, 200.0)];
    for (element, meshes) in [("C3D20R", even), ("C3D10", quadratic)] {
        let program = program(calculix.clone(), element);
        line(&format!("CalculiX {element}"), "CalculiX", Way::Program(program), meshes);
    }
    line("CalculiX C3D8I", "CalculiX", Way::Program(program(calculix, "C3D8I")), linear);
}

fn write(out: &Path, block: &Block, findings: &Findings) -> Result<(), Failed> {
    findings.write_csv(out.join(format!("{}.csv", block.name)))?;
    for ending in ["svg", "png"] {
        findings.write_chart(out.join(format!("{}.{ending}", block.name)))?;
    }
    let mut page = format!("## {}\n\n![chart]({}.png)\n\n", block.title, block.name);
    page += "Processor time (s) to reach an error of the tip (part of its motion), and times as long as the fastest of pliant:\n\n";
    let lines: Vec<_> = findings.lines().iter().collect();
    let label = |error: f64| format!("{} %", (1e3 * error).round() / 10.0);
    page += &report::ranking(&lines, &ACCURACIES, label, time_text, |line, error| {
        line.time_to_reach(error)
    })?;
    page += "\n| line | cells across, rtol or steps | error | unknowns | time, s | steps | forces | factorizations |\n\
             | --- | --- | --- | --- | --- | --- | --- | --- |\n";
    for row in findings.rows() {
        let Some(error) = row.error else { continue };
        let count = |count: Option<usize>| match count {
            None | Some(0) => String::new(),
            Some(count) => count.to_string(),
        };
        writeln!(
            page,
            "| {} | {} | {error:.1e} | {} | {:.3} | {} | {} | {} |",
            row.line,
            row.point,
            count(row.states.map(|states| states / 2)),
            row.seconds,
            count(row.steps),
            count(row.evaluations),
            count(row.factorizations),
        )?;
    }
    page += "\n";
    for note in findings.notes().iter().filter(|note| !note.ends_with(TOO_SLOW)) {
        writeln!(page, "- {note}")?;
    }
    fs::write(out.join(format!("{}.md", block.name)), &page)?;
    println!("{page}");
    Ok(())
}
