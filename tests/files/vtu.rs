//! Files for ParaView as VTK describes them: XML with arrays in base64, whose length in bytes precedes the numbers.

use std::fs;
use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

/// An array of a file.
#[derive(Debug, PartialEq)]
pub struct Array {
    pub name: String,
    pub components: usize,
    pub numbers: Vec<f64>,
}

impl Array {
    pub fn new(name: &str, components: usize, numbers: Vec<f64>) -> Self {
        Self { name: name.into(), components, numbers }
    }
}

/// The arrays of a section: of `PointData`, `CellData`, `Points` or `Cells`.
pub fn arrays(path: &Path, section: &str) -> Vec<Array> {
    let text = fs::read_to_string(path).unwrap();
    let document = roxmltree::Document::parse(&text).unwrap();
    let root = document.root_element();
    let head = ["type", "version", "byte_order", "header_type"].map(|name| root.attribute(name));
    assert_eq!(head, ["UnstructuredGrid", "1.0", "LittleEndian", "UInt64"].map(Some));
    let section = document.descendants().find(|node| node.has_tag_name(section)).unwrap();
    let count = match section.tag_name().name() {
        "PointData" | "Points" => Some("NumberOfPoints"),
        "CellData" => Some("NumberOfCells"),
        _ => None,
    };
    let count = count.map(|name| section.parent().unwrap().attribute(name).unwrap());
    section
        .children()
        .map(|array| {
            let attribute = |name| array.attribute(name);
            assert_eq!(
                (array.tag_name().name(), attribute("format")),
                ("DataArray", Some("binary"))
            );
            let bytes = STANDARD.decode(array.text().unwrap()).unwrap();
            let (length, bytes) = bytes.split_first_chunk().unwrap();
            assert_eq!(u64::from_le_bytes(*length), bytes.len() as u64);
            let eights = || bytes.as_chunks::<8>().0.iter().copied();
            let numbers: Vec<f64> = match attribute("type").unwrap() {
                "Float64" => eights().map(f64::from_le_bytes).collect(),
                "UInt64" => eights().map(|index| u64::from_le_bytes(index) as f64).collect(),
                "UInt8" => bytes.iter().copied().map(f64::from).collect(),
                other => panic!("an array of {other}"),
            };
            let name = attribute("Name").unwrap();
            let components = attribute("NumberOfComponents").map_or(1, |n| n.parse().unwrap());
            if let Some(count) = count {
                assert_eq!(numbers.len(), components * count.parse::<usize>().unwrap(), "{name}");
            }
            let range: [f64; 2] =
                ["RangeMin", "RangeMax"].map(|end| attribute(end).unwrap().parse().unwrap());
            let least = numbers.iter().copied().reduce(f64::min).unwrap();
            assert_eq!(range, [least, numbers.iter().copied().reduce(f64::max).unwrap()], "{name}");
            Array::new(name, components, numbers)
        })
        .collect()
}
