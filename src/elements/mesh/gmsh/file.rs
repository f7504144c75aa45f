//! The sections of a file of Gmsh, of version 4.1 and 2 (<https://gmsh.info/doc/texinfo/gmsh.html#Gmsh-file-formats>).

use std::collections::hash_map::Entry;
use std::collections::{HashMap, HashSet};

use super::reader::Reader;
use super::types::ElementType;

/// Physical groups and entities are identified by dimension and tag.
type Key = (usize, i32);

/// Nodes and elements of a Gmsh file.
pub(super) struct Contents {
    /// Coordinates of the nodes, in the order of the file.
    pub(super) nodes: Vec<[f64; 3]>,
    /// The elements, in the order of the file.
    pub(super) blocks: Vec<Block>,
}

/// Elements of one type on one entity (point, curve, surface or volume).
pub(super) struct Block {
    pub(super) kind: ElementType,
    /// Names of the physical groups of the entity.
    pub(super) groups: Vec<String>,
    /// The nodes of one element after the other, counted from 0 in the order of the file.
    pub(super) nodes: Vec<usize>,
}

impl Block {
    pub(super) fn elements(&self) -> std::slice::ChunksExact<'_, usize> {
        self.nodes.chunks_exact(self.kind.nodes)
    }
}

/// Elements of one type with the same entity and physical groups, as the file has them: nodes by their tags.
struct Run {
    kind: ElementType,
    entity: i32,
    groups: Vec<i32>,
    tags: Vec<u64>,
}

/// The contents of the sections of a file.
#[derive(Default)]
struct Sections {
    names: HashMap<Key, String>,
    /// Physical groups of the entities; files of version 2 have them with the elements.
    groups: HashMap<Key, Vec<i32>>,
    /// The place of each node by its tag.
    places: HashMap<u64, usize>,
    positions: Vec<[f64; 3]>,
    runs: Vec<Run>,
}

impl Contents {
    /// Reads a file; the error describes the mistake in it.
    pub(super) fn read(file: &[u8]) -> Result<Self, String> {
        let mut reader = Reader::new(file);
        let is_old = read_format(&mut reader)?;
        let mut sections = Sections::default();
        let mut seen = HashSet::new();
        while let Some(name) = reader.section()? {
            if matches!(name, b"Nodes" | b"Elements") && !seen.insert(name) {
                return Err(one_section(name));
            }
            match name {
                b"PartitionedEntities" => {
                    return Err("its mesh is partitioned: save it in one piece".into());
                }
                b"PhysicalNames" => sections.names = physical_names(reader.up_to_end(name)?),
                b"Entities" if !is_old => sections.groups = groups(&mut reader)?,
                b"Nodes" if is_old => sections.nodes_2(&mut reader)?,
                b"Nodes" => sections.nodes_4(&mut reader)?,
                b"Elements" if is_old => sections.elements_2(&mut reader)?,
                b"Elements" => sections.elements_4(&mut reader)?,
                _ => {
                    reader.up_to_end(name)?;
                }
            }
            reader.end(name)?;
        }
        for (name, count) in
            [("Nodes", sections.positions.len()), ("Elements", sections.runs.len())]
        {
            if !seen.contains(name.as_bytes()) {
                return Err(one_section(name.as_bytes()));
            }
            if count == 0 {
                let help = "mesh the geometry before saving";
                return Err(format!("its section ${name} is empty: {help}"));
            }
        }
        sections.contents()
    }
}

/// Checks the first section, and returns whether the file is of version 2.
fn read_format(reader: &mut Reader) -> Result<bool, String> {
    match reader.section() {
        Ok(None) => return Err("it is empty".into()),
        Ok(Some(b"MeshFormat")) => {}
        _ => return Err("it does not begin with $MeshFormat, so Gmsh did not write it".into()),
    }
    let format = String::from_utf8_lossy(reader.line().unwrap_or_default());
    let is_old = match *format.split_whitespace().collect::<Vec<_>>() {
        [version @ ("4.1" | "2.2" | "2.1" | "2.0" | "2"), encoding @ ("0" | "1"), "8"] => {
            if encoding == "1" {
                reader.find_byte_order()?;
            }
            version != "4.1"
        }
        [version @ ("4.1" | "2.2"), ..] => {
            let known =
                format!("\"{version} 0 8\" (text) and \"{version} 1 8\" (binary) are known");
            return Err(format!("its format is \"{format}\": only {known}"));
        }
        [version, ..] => {
            let help =
                "export it as 4.1 or 2.2: `gmsh -format msh41`, or \"Version 4 ASCII\" when saving";
            return Err(format!("it has version {version} of the format: {help}"));
        }
        [] => return Err("its format is missing: export it again".into()),
    };
    reader.end(b"MeshFormat")?;
    Ok(is_old)
}

fn one_section(name: &[u8]) -> String {
    let name = String::from_utf8_lossy(name);
    format!("it must have one section ${name}: save the mesh of one model, and all of it")
}

/// A dimension, a tag and a name in quotes on each line.
fn physical_names(section: &[u8]) -> HashMap<Key, String> {
    let name = |line: &str| {
        let (numbers, rest) = line.split_once('"')?;
        let (name, _) = rest.rsplit_once('"')?;
        let mut numbers = numbers.split_whitespace();
        let key = (numbers.next()?.parse().ok()?, numbers.next()?.parse().ok()?);
        Some((key, name.to_owned()))
    };
    String::from_utf8_lossy(section).lines().filter_map(name).collect()
}

/// The physical groups of each entity.
fn groups(reader: &mut Reader) -> Result<HashMap<Key, Vec<i32>>, String> {
    let mut counts = [0; 4];
    for count in &mut counts {
        *count = reader.size("number of entities")?;
    }
    let mut groups = HashMap::new();
    for (dimension, count) in counts.into_iter().enumerate() {
        for _ in 0..count {
            let tag = reader.int("tag of an entity")?;
            // where a point is, or the box around an entity
            for _ in 0..if dimension == 0 { 3 } else { 6 } {
                reader.real("bound of an entity")?;
            }
            let mut tags = || -> Result<Vec<i32>, String> {
                let count = reader.size("number of tags")?;
                (0..count).map(|_| reader.int("tag")).collect()
            };
            groups.insert((dimension, tag), tags()?);
            if dimension > 0 {
                tags()?; // what bounds it
            }
        }
    }
    Ok(groups)
}

impl Sections {
    fn add_node(&mut self, tag: u64, position: [f64; 3]) -> Result<(), String> {
        match self.places.entry(tag) {
            Entry::Occupied(_) => {
                Err(format!("several of its nodes have the tag {tag}, the same tag: renumber them"))
            }
            Entry::Vacant(place) => {
                place.insert(self.positions.len());
                self.positions.push(position);
                Ok(())
            }
        }
    }

    fn nodes_4(&mut self, reader: &mut Reader) -> Result<(), String> {
        let blocks = reader.size("number of blocks")?;
        for what in ["number of nodes", "least tag", "greatest tag"] {
            reader.size(what)?;
        }
        for _ in 0..blocks {
            let dimension = reader.int("dimension of an entity")?;
            reader.int("tag of an entity")?;
            // coordinates on the entity follow those in space
            let parameters = if reader.int("flag")? == 0 { 0 } else { dimension.clamp(0, 3) };
            let count = reader.size("number of nodes")?;
            let tags = (0..count).map(|_| reader.size("tag of a node"));
            for tag in tags.collect::<Result<Vec<u64>, String>>()? {
                let position = reader.point()?;
                for _ in 0..parameters {
                    reader.real("parametric coordinate")?;
                }
                self.add_node(tag, position)?;
            }
        }
        Ok(())
    }

    fn nodes_2(&mut self, reader: &mut Reader) -> Result<(), String> {
        for _ in 0..reader.count_line()? {
            let tag = reader.int("number of a node")?;
            let tag =
                u64::try_from(tag).map_err(|_| reader.broken("a node has a number below 0"))?;
            let position = reader.point()?;
            self.add_node(tag, position)?;
        }
        Ok(())
    }

    fn elements_4(&mut self, reader: &mut Reader) -> Result<(), String> {
        let blocks = reader.size("number of blocks")?;
        for what in ["number of elements", "least tag", "greatest tag"] {
            reader.size(what)?;
        }
        let mut memberships = 0;
        for _ in 0..blocks {
            reader.int("dimension of an entity")?;
            let entity = reader.int("tag of an entity")?;
            let kind = kind(reader)?;
            let count = reader.size("number of elements")?;
            let groups = self.groups.get(&(kind.dimension, entity)).cloned().unwrap_or_default();
            // each block has a copy of the groups of its entity
            memberships += groups.len();
            if memberships > reader.file_length() {
                let problem = "its entities have too many physical groups for so many blocks";
                return Err(reader.broken(problem));
            }
            let mut tags = Vec::new();
            for _ in 0..count {
                reader.size("tag of an element")?;
                for _ in 0..kind.nodes {
                    tags.push(reader.size("node of an element")?);
                }
            }
            if count > 0 {
                self.runs.push(Run { kind, entity, groups, tags });
            }
        }
        Ok(())
    }

    fn elements_2(&mut self, reader: &mut Reader) -> Result<(), String> {
        let count = reader.count_line()?;
        let (mut done, mut last) = (0, None);
        while done < count {
            // in a text each element has a head of its own, after its number; in binary files a head serves several
            if reader.is_text() {
                reader.int("number of an element")?;
            }
            let kind = kind(reader)?;
            let elements = if reader.is_text() { 1 } else { reader.int("number of elements")? };
            let tags = reader.int("number of tags")?;
            let elements =
                usize::try_from(elements).ok().filter(|n| (1..=count - done).contains(n));
            let elements = elements.ok_or_else(|| reader.broken("its counts do not agree"))?;
            for _ in 0..elements {
                if !reader.is_text() {
                    reader.int("number of an element")?;
                }
                // the physical group, the entity, and partitions
                let [mut group, mut entity] = [0; 2];
                for place in 0..tags {
                    let tag = reader.int("tag of an element")?;
                    match place {
                        0 => group = tag,
                        1 => entity = tag,
                        _ => {}
                    }
                }
                let node = |_| {
                    let tag = reader.int("node of an element")?;
                    u64::try_from(tag).map_err(|_| reader.broken("an element has a node below 0"))
                };
                let tags = (0..kind.nodes).map(node).collect::<Result<Vec<u64>, String>>()?;
                let groups = Vec::from_iter(Some(group).filter(|group| *group != 0));
                self.add_element(&mut last, Run { kind, entity, groups, tags });
            }
            done += elements;
        }
        last.into_iter().for_each(|last| self.push(last));
        Ok(())
    }

    /// Adds an element of a file of version 2 after the `last` one. Elements of several groups are written once for each of
    /// these, one after the other.
    fn add_element(&mut self, last: &mut Option<Run>, element: Run) {
        match last {
            Some(last)
                if (last.kind, last.entity, &last.tags)
                    == (element.kind, element.entity, &element.tags)
                    && element.groups.iter().any(|group| !last.groups.contains(group)) =>
            {
                last.groups.extend(element.groups);
            }
            _ => last.replace(element).into_iter().for_each(|last| self.push(last)),
        }
    }

    /// Adds elements, to those before them if these are of the same kind, entity and groups.
    fn push(&mut self, run: Run) {
        match self.runs.last_mut() {
            Some(last)
                if (last.kind, last.entity, &last.groups)
                    == (run.kind, run.entity, &run.groups) =>
            {
                last.tags.extend(run.tags);
            }
            _ => self.runs.push(run),
        }
    }

    /// The mesh that the sections describe.
    fn contents(self) -> Result<Contents, String> {
        let place = |tag: &u64| {
            let place = self.places.get(tag).copied();
            place.ok_or_else(|| {
                format!("an element has the node {tag}, which does not exist: save all elements")
            })
        };
        let mut blocks = Vec::with_capacity(self.runs.len());
        for run in &self.runs {
            let group = |tag: &i32| {
                let tag = tag.wrapping_abs(); // its sign is the orientation in the group
                let named = self.names.get(&(run.kind.dimension, tag)).cloned();
                named.unwrap_or_else(|| format!("{} {tag}", run.kind.entity()))
            };
            blocks.push(Block {
                kind: run.kind,
                groups: run.groups.iter().map(group).collect(),
                nodes: run.tags.iter().map(place).collect::<Result<_, _>>()?,
            });
        }
        Ok(Contents { nodes: self.positions, blocks })
    }
}

fn kind(reader: &mut Reader) -> Result<ElementType, String> {
    let number = reader.int("type of elements")?;
    ElementType::of(number).ok_or_else(|| {
        reader.broken(format!(
            "elements of type {number} are not known: take Mesh.ElementOrder 1 or 2"
        ))
    })
}
