//! Files of checkpoints that cannot be used: of other scenes, of other formats, damaged.

use std::fs;
use std::path::Path;

use pliant::samples::SQUARE_MATERIAL;
use pliant::{
    Body, Cells, Chamber, Error, Material, Mesh, Method, Obstacle, Phase, Scene, Settings, Signal,
    Spring, Strain,
};
use serde_json::{Value, json};

use crate::checkpoint_file::{beam, command, driven, folder};
use crate::common::settings;

#[track_caller]
fn says<T>(result: Result<T, Error>, words: &[&str]) {
    let Err(error) = result else { panic!("accepted; expected {words:?}") };
    let message = error.to_string();
    println!("{message}");
    for word in words {
        assert!(message.contains(word), "\"{word}\" is missing from: {message}");
    }
}

#[test]
fn functions_that_commands_gave_are_named() {
    let (_folder, path) = folder();
    let mut beam = driven().start(&settings(Method::Arkode, 1e-5)).unwrap();
    beam.checkpoint().write(&path).unwrap();
    let before = fs::read(&path).unwrap();
    let help = "a function of time cannot be used: a file cannot hold it; command a constant";
    beam.pressure("inside", Signal::function(|t| t)).unwrap();
    says(beam.checkpoint().write(&path), &["pressure of chamber \"inside\"", help]);
    beam.pressure("inside", 1.0).unwrap();
    beam.actuate("tendon", Signal::function(|t| t)).unwrap();
    says(beam.checkpoint().write(&path), &["actuation of \"tendon\"", help]);
    beam.actuate("tendon", Signal::table([0.0, 1.0], [0.0, 1.0])).unwrap();
    beam.load_with("right", |t| [t, 0.0]).unwrap();
    says(beam.checkpoint().write(&path), &["load on \"right\"", help]);
    assert_eq!(before, fs::read(&path).unwrap());
    beam.load("right", [0.0, 0.0]).unwrap();
    beam.checkpoint().write(&path).unwrap();
    assert_ne!(before, fs::read(&path).unwrap());
    says(beam.checkpoint().write("/proc/no/such/place"), &["cannot write", "/proc/no/such/place"]);
}

/// Each part of a scene that differs is named, the numbers of nodes first.
#[test]
fn other_scenes_are_refused_by_what_differs() {
    let (_folder, path) = folder();
    let settings = settings(Method::Arkode, 1e-5);
    let phases = |scene: Scene| scene.phase(Phase::until(0.1).hold("left").named("swing"));
    phases(beam()).start(&settings).unwrap().checkpoint().write(&path).unwrap();
    let body = |size: f64, nodes: usize, cells, young: f64| {
        let mesh = Mesh::rectangle([size, 0.02], [nodes, 3], cells).unwrap();
        let material = Material { young, ..SQUARE_MATERIAL };
        Body::new(mesh, material).thickness(0.01).strain(Strain::Green).build().unwrap()
    };
    let young = SQUARE_MATERIAL.young;
    let like = |body: Body| {
        let floor = Obstacle::half_plane([0.0, 0.0003], [0.0, 1.0]).stiffness(500.0).named("floor");
        Scene::new(body)
            .chamber(Chamber::within("inside", [1, 11, 33, 23]))
            .spring(Spring::between([11], [23]).named("tendon"))
            .obstacle(floor)
            .gravity([0.0, -9.8])
    };
    let read = |scene: Scene| scene.start(&settings).unwrap().read_checkpoint(&path);
    assert!(read(phases(like(body(0.1, 11, Cells::Rectangles, young)))).is_ok());
    let file = path.to_str().unwrap();
    let help = "read it by a simulation of the scene that it was written for";
    let bar = Body::new(Mesh::bar(0.1, 5).unwrap(), SQUARE_MATERIAL)
        .strain(Strain::Cauchy)
        .area(1e-4)
        .build()
        .unwrap();
    says(read(phases(Scene::new(bar))), &[file, "nodes: it is of a scene with 33", "has 5", help]);
    says(
        read(phases(like(body(0.1, 11, Cells::Triangles, young)))),
        &["cells: ", "20", "40", help],
    );
    let ball = Obstacle::disc([0.0, -1.0], 0.1).stiffness(1.0).named("ball");
    let others = [
        (like(body(0.101, 11, Cells::Rectangles, young)), "positions of the nodes: they differ"),
        (like(body(0.1, 11, Cells::Rectangles, 1.001 * young)), "materials: they differ"),
        (beam().gravity([0.0, -9.81]), "gravity: they differ"),
        (beam().spring(Spring::between([1], [2])), "springs: they differ"),
        (beam().chamber(Chamber::within("more", [1, 2, 13, 12])), "chambers: they differ"),
        (beam().obstacle(ball), "obstacles: they differ"),
        (beam().spin([0.1]), "displacements and velocities at the start: they differ"),
        (beam().initial_velocity_of([33], [0.0, 1.0]), "velocities at the start: they differ"),
    ];
    for (other, words) in others {
        says(read(phases(other)), &[file, words, "the scene in the file", help]);
    }
    let others = [
        (
            phases(beam()).phase(Phase::until(0.2)),
            "phases: it is of a scene with 1, this one has 2",
        ),
        (
            beam().phase(Phase::until(0.2).hold("left").named("swing")),
            "number 1 is \"swing\" until 0.1 s, here it is \"swing\" until 0.2 s",
        ),
        (
            beam().phase(Phase::until(0.1).hold("right").named("swing")),
            "what \"swing\" holds, moves, loads or touches differs",
        ),
    ];
    for (other, words) in others {
        says(read(other), &[file, words, help]);
    }
}

/// A file in which `edit` has changed something.
fn forged(path: &Path, edit: impl FnOnce(&mut Value)) {
    let mut file: Value = serde_json::from_slice(&fs::read(path).unwrap()).unwrap();
    edit(&mut file);
    fs::write(path, serde_json::to_vec(&file).unwrap()).unwrap();
}

/// The first input of a quantity in force: that, its target and its signal.
fn input<'a>(file: &'a mut Value, quantity: &str) -> &'a mut Value {
    let inputs = file["in_force"]["inputs"].as_array_mut().unwrap();
    let is_it = |input: &&mut Value| input[0] == *quantity || input[0].get(quantity).is_some();
    inputs.iter_mut().find(is_it).unwrap()
}

#[test]
fn files_that_are_not_what_they_should_be_are_refused() {
    let (_folder, path) = folder();
    let settings = settings(Method::Auto, 1e-5);
    let mut beam = driven().start(&settings).unwrap();
    command(&mut beam);
    let before = beam.sample().unwrap();
    beam.checkpoint().write(&path).unwrap();
    let whole = fs::read(&path).unwrap();
    type Edit<'a> = &'a dyn Fn(&mut Value);
    let edits: [(Edit, &[&str]); 26] = [
        (&|file| file["what"] = json!("poem"), &["does not say \"pliant checkpoint\""]),
        (&|file| *file = json!([1, 2]), &["does not say \"pliant checkpoint\""]),
        (
            &|file| (file["format"], file["version"]) = (json!(7), json!("0.3.0")),
            &["format 7 of pliant 0.3.0: this version", "reads formats 5 to 6"],
        ),
        (&|file| file["more"] = json!(1), &["damaged", "more"]),
        (&|file| _ = file.as_object_mut().unwrap().remove("steps"), &["damaged", "steps"]),
        (&|file| _ = file.as_object_mut().unwrap().remove("next_step"), &["damaged", "next_step"]),
        (&|file| file["time"] = json!(0.005), &["time 0.005 s", "\"drive\"", "0.01 s to 0.1 s"]),
        (&|file| file["time"] = json!(null), &["damaged", "null"]),
        (&|file| file["phase"] = json!(2), &["phase 2 is outside 0 to 1"]),
        (&|file| file["phase"] = json!(-1), &["damaged", "-1"]),
        (&|file| file["displacements"][7] = json!(null), &["damaged", "null"]),
        (&|file| file["velocities"] = json!([0.0]), &["1 velocities", "66"]),
        (&|file| file["displacements"].as_array_mut().unwrap().push(json!(0)), &["67", "66"]),
        (&|file| file["displacements"][20] = json!(-1e3), &["state", "cell"]),
        (&|file| file["velocities"][20] = json!(1e300), &["state", "range of double precision"]),
        (&|file| file["next_step"] = json!(0.0), &["next_step 0 s"]),
        (&|file| file["steps"] = json!(u64::MAX), &["steps", "above"]),
        (&|file| file["chosen"]["patience"] = json!(u64::MAX), &["patience", "above"]),
        (&|file| file["chosen"]["method"] = json!("auto"), &["chosen method"]),
        (&|file| file["chosen"]["method"] = json!("euler"), &["euler", "cvode-bdf"]),
        (
            &|file| file["constraint_starts"] = json!([[0.0, 0.0, 0.0, 0.0]]),
            &["origins = 1", "rows"],
        ),
        (&|file| file["in_force"]["contact"] = json!(["wall"]), &["\"wall\"", "floor"]),
        (
            &|file| input(file, "pressure")[1] = json!({ "named": ["tank"] }),
            &["\"tank\"", "inside"],
        ),
        (
            &|file| input(file, "load")[2] = json!({ "vector": { "of_scene": 9 } }),
            &["phase in the scene has no signal 9"],
        ),
        (
            &|file| input(file, "load")[1] = json!({ "nodes": { "set": "tip" } }),
            &["\"tip\"", "right"],
        ),
        (
            &|file| input(file, "load")[1] = json!({ "nodes": { "numbers": [34] } }),
            &["node = 34", "1 to 33"],
        ),
    ];
    let file = path.to_str().unwrap();
    for (edit, words) in edits {
        fs::write(&path, &whole).unwrap();
        forged(&path, edit);
        says(beam.read_checkpoint(&path), &[&[file], words].concat());
    }
    let nested = br#"{ "what": "pliant checkpoint", "more": "#.to_vec();
    let nested = [nested, vec![b'['; 100_000]].concat();
    let texts: [(&[u8], &str); 6] = [
        (b"", "cut off"),
        (&whole[..whole.len() / 2], "cut off"),
        (b"displacements: none", "damaged"),
        (b"\xff\xfe\x00", "damaged"),
        (&nested, "damaged"),
        (&vec![b' '; 17 << 20], "more than 16811008 bytes"),
    ];
    for (text, words) in texts {
        fs::write(&path, text).unwrap();
        says(beam.read_checkpoint(&path), &[file, words]);
    }
    let text = String::from_utf8(whole.clone()).unwrap();
    let too_large = text.replacen("\"time\": ", "\"time\": 1e999, \"was\": ", 1);
    fs::write(&path, too_large).unwrap();
    says(beam.read_checkpoint(&path), &[file, "damaged", "out of range"]);
    says(beam.read_checkpoint("/dev/zero"), &["/dev/zero", "no regular file"]);
    says(beam.read_checkpoint(path.parent().unwrap()), &["no regular file"]);
    says(beam.read_checkpoint("no/such/file"), &["cannot read no/such/file"]);
    assert_eq!(beam.sample().unwrap(), before);
    fs::write(&path, &whole).unwrap();
    assert!(beam.read_checkpoint(&path).is_ok());
}

/// Random numbers: splitmix64.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, count: usize) -> usize {
        (self.next() % count as u64) as usize
    }
}

/// The file with one thing wrong, or several.
fn mutated(whole: &[u8], random: &mut Random) -> Vec<u8> {
    let mut bytes = whole.to_vec();
    for _ in 0..1 + random.below(3) {
        let at = random.below(bytes.len());
        match random.below(5) {
            0 => bytes[at] ^= 1 << random.below(8),
            1 => bytes[at] = b"0123456789-+.eE[]{}\",:n \n"[random.below(25)],
            2 => bytes.truncate(at + 1),
            3 => _ = bytes.remove(at),
            _ => {
                let mut lines: Vec<&[u8]> = bytes.split(|byte| *byte == b'\n').collect();
                let [a, b] = [random.below(lines.len()), random.below(lines.len())];
                lines.swap(a, b);
                bytes = lines.join(&b'\n');
            }
        }
    }
    bytes
}

/// Whatever becomes of a file, reading it ends with a checkpoint or with an error that names the file; and what is
/// read can be restored and goes on, or ends as a run ends.
#[test]
fn files_that_were_damaged_at_random_break_nothing() {
    let (_folder, path) = folder();
    let settings = Settings { max_steps: 200, ..settings(Method::Auto, 1e-3) };
    let mut beam = driven().start(&settings).unwrap();
    command(&mut beam);
    beam.checkpoint().write(&path).unwrap();
    let whole = fs::read(&path).unwrap();
    let head = whole.windows(15).position(|text| text == b"\"displacements\"").unwrap();
    let mut random = Random(7);
    let [mut refused, mut read, mut failed] = [0; 3];
    for round in 0..600 {
        // half of them in what comes before the many numbers of the state
        let bytes = match round % 2 {
            0 => mutated(&whole, &mut random),
            _ => [&mutated(&whole[..head], &mut random), &whole[head..]].concat(),
        };
        fs::write(&path, bytes).unwrap();
        match beam.read_checkpoint(&path) {
            Ok(checkpoint) => {
                read += 1;
                beam.restore(&checkpoint).unwrap();
                let end = (beam.time() + 1e-3).min(beam.scene().end());
                failed += usize::from(beam.advance_to(end).is_err());
            }
            Err(error) => {
                refused += 1;
                assert!(error.to_string().contains(path.to_str().unwrap()), "{error}");
            }
        }
    }
    println!("{refused} refused, {read} read, of which {failed} failed later");
    assert!(refused > 300 && read > 30, "{refused} {read}");
}
