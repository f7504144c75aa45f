//! Pictures as pixels.

use std::error::Error;
use std::sync::Arc;

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree, fontdb};

/// Pixels of the picture to one of the drawing: sharp on fine screens.
const SCALE: f32 = 2.0;

/// Renders a drawing (SVG) to a picture (PNG), with the fonts of this machine.
///
/// # Errors
/// A machine without fonts; a drawing that is none.
pub(crate) fn png(svg: &str) -> Result<Vec<u8>, Box<dyn Error + Send + Sync>> {
    let mut fonts = fontdb::Database::new();
    fonts.load_system_fonts();
    let Some(any) = fonts.faces().next().map(|face| face.families[0].0.clone()) else {
        return Err("this machine has no fonts: install some, or write SVG".into());
    };
    // where none of the fonts asked for is known, one that is
    let sans = ["Arial", "Liberation Sans", "DejaVu Sans"].map(String::from);
    let known = |name: &String| fonts.faces().any(|face| face.families[0].0 == *name);
    let family = sans.into_iter().find(known).unwrap_or(any);
    fonts.set_sans_serif_family(family);
    let options = Options { fontdb: Arc::new(fonts), ..Options::default() };
    let tree = Tree::from_str(svg, &options)?;
    let size = tree.size().to_int_size().scale_by(SCALE).ok_or("the drawing has no size")?;
    let mut picture = Pixmap::new(size.width(), size.height()).ok_or("the drawing has no size")?;
    resvg::render(&tree, Transform::from_scale(SCALE, SCALE), &mut picture.as_mut());
    Ok(picture.encode_png()?)
}
