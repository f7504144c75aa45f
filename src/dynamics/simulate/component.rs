//! Components of vectors and tensors.

use crate::base::input::{InputError, unknown_among};

/// A part of a vector or tensor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Component {
    /// Along the first axis.
    X,
    /// Along the second axis.
    Y,
    /// Along the third axis.
    Z,
    /// The length of a vector.
    Norm,
    /// First diagonal entry of a tensor.
    XX,
    /// Second diagonal entry.
    YY,
    /// Third diagonal entry: across the plane, of a body in two dimensions.
    ZZ,
    /// Entry of the first and second axis; for strain that of the tensor, half the change of the right angle.
    XY,
    /// Entry of the second and third axis.
    YZ,
    /// Entry of the first and third axis.
    XZ,
    /// The von Mises stress.
    VonMises,
}

impl Component {
    /// All of them with their words.
    pub(crate) const WORDS: [(&'static str, Self); 11] = [
        ("x", Self::X),
        ("y", Self::Y),
        ("z", Self::Z),
        ("norm", Self::Norm),
        ("xx", Self::XX),
        ("yy", Self::YY),
        ("zz", Self::ZZ),
        ("xy", Self::XY),
        ("yz", Self::YZ),
        ("xz", Self::XZ),
        ("von-mises", Self::VonMises),
    ];

    /// Its word: `x`, `norm`, `xy`, `von-mises`, ...
    pub fn word(self) -> &'static str {
        let of_this = Self::WORDS.iter().find(|(_, component)| *component == self);
        of_this.map_or("", |(word, _)| word)
    }

    /// # Errors
    /// If it is none of the `known` ones, which are all that a quantity has.
    pub(super) fn check(self, known: &[Self]) -> Result<(), InputError> {
        if known.contains(&self) {
            return Ok(());
        }
        let known: Vec<&str> = known.iter().map(|component| component.word()).collect();
        let help = unknown_among(self.word(), &known, "quantity", "components");
        Err(InputError::new("component", format!("\"{}\"", self.word()), help))
    }
}
