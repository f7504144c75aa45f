//! The file: what `mshio` reads of it, guarded where it would panic or lose data, and the names of
//! physical groups.

use std::collections::HashMap;

use mshio::error::MshParserErrorKind;
use mshio::{ElementType, Entities, MshData, MshParserError};

/// Physical groups and entities are identified by dimension and tag.
type Key = (i32, i32);

/// What a mesh is made from.
pub(super) struct Contents {
    /// Coordinates of the nodes, in the order of the file.
    pub(super) nodes: Vec<[f64; 3]>,
    /// The elements, in the order of the file.
    pub(super) blocks: Vec<Block>,
}

/// Elements of one type on one entity (point, curve, surface or volume).
pub(super) struct Block {
    pub(super) kind: ElementType,
    /// Dimension of the entity.
    pub(super) dimension: i32,
    /// Names of the physical groups of the entity.
    pub(super) groups: Vec<String>,
    /// The nodes of each element, counted from 0 in the order of the file.
    pub(super) elements: Vec<Vec<usize>>,
}

impl Contents {
    /// Reads a file, or says what is wrong with it.
    pub(super) fn read(mut file: Vec<u8>) -> Result<Self, String> {
        let binary = check_format(&file)?;
        if find(&file, "$PartitionedEntities").next().is_some() {
            return Err("its mesh is partitioned: save it in one piece".into());
        }
        prepare_section(&mut file, "$Nodes", binary)?;
        prepare_section(&mut file, "$Elements", binary)?;
        let data =
            mshio::parse_msh_bytes(&file).map_err(|error| broken(&file, binary, &error))?.data;
        let MshData { entities, nodes: Some(nodes), elements: Some(elements) } = data else {
            return Err("it has no nodes, or no elements".into());
        };

        let (mut positions, mut places) = (Vec::new(), HashMap::new());
        for block in nodes.node_blocks {
            let tags = block.node_tags.into_iter().flatten();
            places.extend(tags.map(|(tag, index)| (tag, positions.len() + index)));
            positions.extend(block.nodes.iter().map(|node| [node.x, node.y, node.z]));
        }
        if places.len() != positions.len() {
            return Err("several of its nodes have the same tag".into());
        }
        let place = |tag: &u64| {
            let place = places.get(tag).copied();
            place.ok_or_else(|| format!("an element has the node {tag}, which does not exist"))
        };
        let names = physical_names(&file);
        let groups = entities.map(|entities| groups(&entities, &names)).unwrap_or_default();
        let mut blocks = Vec::with_capacity(elements.element_blocks.len());
        for block in elements.element_blocks {
            let nodes = |element: &mshio::Element<u64>| element.nodes.iter().map(place).collect();
            let entity = (block.entity_dim, block.entity_tag);
            blocks.push(Block {
                kind: block.element_type,
                dimension: block.entity_dim,
                groups: groups.get(&entity).cloned().unwrap_or_default(),
                elements: block.elements.iter().map(nodes).collect::<Result<_, String>>()?,
            });
        }
        Ok(Self { nodes: positions, blocks })
    }
}

/// Checks the first two lines, and returns whether the rest is binary.
fn check_format(file: &[u8]) -> Result<bool, String> {
    let mut lines = file.split(|&byte| byte == b'\n').map(|line| line.trim_ascii());
    match lines.next() {
        None | Some(b"") => return Err("it is empty".into()),
        Some(b"$MeshFormat") => {}
        Some(_) => {
            return Err("it does not begin with $MeshFormat, so Gmsh did not write it".into());
        }
    }
    let format = String::from_utf8_lossy(lines.next().unwrap_or_default());
    match *format.split_whitespace().collect::<Vec<_>>() {
        ["4.1", "0", "8"] => Ok(false),
        ["4.1", "1", "8"] => Ok(true),
        ["4.1", ..] => {
            Err(format!("its format is \"{format}\": only \"4.1 0 8\" and \"4.1 1 8\" are known"))
        }
        [version, ..] => {
            let help = "export it as 4.1: `gmsh -format msh41`, or \"Version 4 ASCII\" when saving";
            Err(format!("it has version {version} of the format: {help}"))
        }
        [] => Err("its format is missing".into()),
    }
}

/// Where `name` stands in the file: the places after it.
fn find<'a>(file: &'a [u8], name: &'a str) -> impl Iterator<Item = usize> + 'a {
    let windows = file.windows(name.len()).enumerate();
    windows.filter(|(_, window)| *window == name.as_bytes()).map(|(at, _)| at + name.len())
}

/// Checks that a section exists and is not empty, which `mshio` takes for granted, and sets the greatest tag
/// in its header to the greatest number. For `mshio` keeps tags only if the header says that they have gaps;
/// but tags without gaps may be out of order, too (as after the order of a mesh was raised), and elements
/// would get wrong nodes.
fn prepare_section(file: &mut Vec<u8>, name: &str, binary: bool) -> Result<(), String> {
    let mut places = find(file, name);
    let (Some(start), None) = (places.next(), places.next()) else {
        return Err(format!("it must have one section {name}"));
    };
    drop(places);
    let header = line_end(file, start);
    let broken = || format!("the header of its section {name} is broken");
    let count = if binary {
        let count = file.get(header + 8..header + 16).ok_or_else(broken)?.iter().any(|&b| b != 0);
        file.get_mut(header + 24..header + 32).ok_or_else(broken)?.fill(u8::MAX);
        usize::from(count)
    } else {
        let end = line_end(file, header);
        let line = String::from_utf8_lossy(&file[header..end]).into_owned();
        let [blocks, count, least, _] = *line.split_whitespace().collect::<Vec<_>>() else {
            return Err(broken());
        };
        let largest = format!("{blocks} {count} {least} {}\n", u64::MAX);
        file.splice(header..end, largest.into_bytes());
        count.parse().map_err(|_| broken())?
    };
    if count == 0 {
        return Err(format!("its section {name} is empty: mesh the geometry before saving"));
    }
    Ok(())
}

/// The beginning of the next line, or the end of the file.
fn line_end(file: &[u8], from: usize) -> usize {
    let length = file[from..].iter().position(|&byte| byte == b'\n');
    length.map_or(file.len(), |length| from + length + 1)
}

/// Where and what `mshio` could not read. (Its own message would hold all the rest of the file.)
fn broken(file: &[u8], binary: bool, error: &MshParserError<&[u8]>) -> String {
    let at = error.backtrace.first().map_or(0, |(rest, _)| file.len() - rest.len());
    let place = match binary {
        true => format!("byte {at}"),
        false => format!("line {}", file[..at].iter().filter(|&&byte| byte == b'\n').count() + 1),
    };
    let kinds = || error.backtrace.iter().rev().map(|(_, kind)| kind);
    let reading: Vec<&str> = kinds().filter_map(MshParserErrorKind::context).collect();
    let reading = if reading.is_empty() { "sections".into() } else { reading.join(", ") };
    match kinds().any(|kind| *kind == MshParserErrorKind::Unimplemented) {
        true => {
            let help = "save it with Mesh.SaveParametric = 0, and with simple cells";
            format!("it cannot be read at {place}, in its {reading}: {help}")
        }
        false => format!("it is broken at {place}, in its {reading}"),
    }
}

/// The section of physical names: a dimension, a tag and a name in quotes on each line.
fn physical_names(file: &[u8]) -> HashMap<Key, String> {
    let bounds = (find(file, "$PhysicalNames").next(), find(file, "$EndPhysicalNames").next());
    let (Some(start), Some(end)) = bounds else { return HashMap::new() };
    let section = String::from_utf8_lossy(file.get(start..end).unwrap_or_default());
    let name = |line: &str| {
        let (numbers, rest) = line.split_once('"')?;
        let (name, _) = rest.rsplit_once('"')?;
        let mut numbers = numbers.split_whitespace().map(|number| number.parse().ok());
        Some(((numbers.next()??, numbers.next()??), name.to_owned()))
    };
    section.lines().filter_map(name).collect()
}

/// Names of the groups of each entity. A group without a name is called by what it consists of and
/// its tag: `curve 7`.
fn groups(
    entities: &Entities<i32, f64>,
    names: &HashMap<Key, String>,
) -> HashMap<Key, Vec<String>> {
    let mut groups = HashMap::new();
    let mut add = |dimension: i32, what: &str, entity: i32, tags: &[i32]| {
        let name = |tag: &i32| {
            let tag = tag.wrapping_abs(); // its sign is the orientation in the group
            names.get(&(dimension, tag)).cloned().unwrap_or_else(|| format!("{what} {tag}"))
        };
        groups.insert((dimension, entity), tags.iter().map(name).collect());
    };
    entities.points.iter().for_each(|e| add(0, "point", e.tag, &e.physical_tags));
    entities.curves.iter().for_each(|e| add(1, "curve", e.tag, &e.physical_tags));
    entities.surfaces.iter().for_each(|e| add(2, "surface", e.tag, &e.physical_tags));
    entities.volumes.iter().for_each(|e| add(3, "volume", e.tag, &e.physical_tags));
    groups
}
