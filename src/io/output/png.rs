//! Pictures as pixels.

use std::error::Error;
use std::sync::Arc;

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree, fontdb};

/// Pixels of the picture per pixel of the drawing: sharp on fine screens.
const SCALE: f32 = 2.0;

/// Renders a drawing (SVG) to a picture (PNG), with the fonts of this machine.
///
/// # Errors
/// A machine without fonts; a drawing that is not valid.
pub(crate) fn png(svg: &str) -> Result<Vec<u8>, Box<dyn Error + Send + Sync>> {
    let mut fonts = fontdb::Database::new();
    fonts.load_system_fonts();
    // if none of the requested fonts is installed, take one that is; the first of all may be a font of
    // symbols, without letters
    let family = |is_right: &dyn Fn(&str) -> bool| {
        let mut families = fonts.faces().flat_map(|face| &face.families);
        families.find(|(name, _)| is_right(name)).map(|(name, _)| name.clone())
    };
    let sans = ["Arial", "Liberation Sans", "DejaVu Sans"];
    let found = sans.iter().find_map(|sans| family(&|name| name == *sans));
    let found = found.or_else(|| family(&|name| name.contains("Sans")));
    let Some(found) = found.or_else(|| family(&|_| true)) else {
        return Err("this machine has no fonts: install some, or write SVG".into());
    };
    fonts.set_sans_serif_family(found);
    let options = Options { fontdb: Arc::new(fonts), ..Options::default() };
    let tree = Tree::from_str(svg, &options)?;
    let size = tree.size().to_int_size().scale_by(SCALE).ok_or("the drawing has no size")?;
    let mut picture = Pixmap::new(size.width(), size.height()).ok_or("the drawing has no size")?;
    resvg::render(&tree, Transform::from_scale(SCALE, SCALE), &mut picture.as_mut());
    Ok(picture.encode_png()?)
}
