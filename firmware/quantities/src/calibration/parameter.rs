//! Scalars of the calibration: each is declared once, with unit, default, range, class and reason.
//!
//! The declaration gives the `#[repr(C)]` field that the ECU uses, the range check that guards it, and
//! the description from which tools (calibration files, XCP, documentation) read and write it.

use super::class::Class;

/// What a tool needs to know of one scalar.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ParameterInfo {
    /// Name without unit.
    pub name: &'static str,
    /// Suffix of the engineering unit.
    pub suffix: &'static str,
    /// Raw counts in one engineering unit.
    pub counts_per_unit: i32,
    /// Smallest allowed value, raw counts.
    pub min: i32,
    /// Largest allowed value, raw counts.
    pub max: i32,
    /// Default, raw counts.
    pub nominal: i32,
    /// Who may change it, and when.
    pub class: Class,
    /// What it is and why it has that default. Empty on the ECU, whose flash it would fill with prose.
    pub reason: &'static str,
}

/// A value outside its range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OutOfRange {
    /// The scalar in question.
    pub parameter: &'static ParameterInfo,
    /// What was found, raw counts.
    pub found: i32,
}

/// A group of scalars that belong to one part of the controller.
pub trait ParameterGroup: Sized {
    /// Name of the group, as the section of a calibration file.
    const NAME: &'static str;
    /// Descriptions, in the order of the fields.
    const INFO: &'static [ParameterInfo];

    /// Raw counts of field `index`, if there is such a field.
    fn get(&self, index: usize) -> Option<i32>;
    /// Sets field `index`, if there is such a field, without checking its range.
    fn set(&mut self, index: usize, counts: i32);

    /// Visits the raw counts of every field, in their order.
    fn visit(&mut self, visit: &mut dyn FnMut(&mut i32));
}

/// A group of scalars, as it follows the tables of a block.
#[derive(Clone, Copy, Debug)]
pub struct Group {
    /// Name of the group.
    pub name: &'static str,
    /// Its scalars, a word each.
    pub parameters: &'static [ParameterInfo],
}

impl Group {
    /// The group of a type.
    pub(super) const fn of<G: ParameterGroup>() -> Self {
        Self {
            name: G::NAME,
            parameters: G::INFO,
        }
    }
}

/// Declares a group: `name: Type = default, min..=max, class;` with the reason as doc comment.
macro_rules! parameter_group {
    (
        $(#[$meta:meta])*
        $Group:ident, $group_name:literal {
            $( $(#[doc = $doc:literal])+ $field:ident : $Type:ident = $nominal:literal, $min:literal ..= $max:literal, $class:ident; )+
        }
    ) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[repr(C)]
        pub struct $Group {
            $( $(#[doc = $doc])+ pub $field: $Type, )+
        }

        impl $Group {
            /// The defaults.
            pub const NOMINAL: Self = Self { $( $field: $Type($nominal), )+ };
        }

        impl $crate::calibration::parameter::ParameterGroup for $Group {
            const NAME: &'static str = $group_name;
            const INFO: &'static [$crate::calibration::parameter::ParameterInfo] = &[
                $( $crate::calibration::parameter::ParameterInfo {
                    name: stringify!($field),
                    suffix: <$Type as $crate::units::Quantity>::SUFFIX,
                    counts_per_unit: <$Type as $crate::units::Quantity>::COUNTS_PER_UNIT,
                    min: $min,
                    max: $max,
                    nominal: $nominal,
                    class: $crate::calibration::class::Class::$class,
                    reason: if cfg!(target_os = "none") { "" } else { concat!($($doc),+) },
                }, )+
            ];

            fn get(&self, index: usize) -> Option<i32> {
                [$( self.$field.0, )+].get(index).copied()
            }

            fn visit(&mut self, visit: &mut dyn FnMut(&mut i32)) {
                [$( &mut self.$field.0, )+].into_iter().for_each(visit);
            }

            fn set(&mut self, index: usize, counts: i32) {
                if let Some(field) = [$( &mut self.$field.0, )+].into_iter().nth(index) {
                    *field = counts;
                }
            }
        }
    };
}

pub(crate) use parameter_group;
