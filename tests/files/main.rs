//! What is read and written: scene files, meshes from Gmsh, tables, pictures, reports.

mod acting;
mod documentation;
mod gmsh;
mod output;
mod output_of_cells;
mod overrides;
mod plots;
mod reference;
mod report;
mod scene_file_errors;
mod scene_file_words;
mod scene_files;
mod sensors;
mod smaller_models;
mod vtu;
