//! The variables of a unit.

/// A value of a variable.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// A real number.
    Real(f64),
    /// A whole number.
    Integer(i32),
    /// True or false.
    Boolean(bool),
    /// A text.
    Text(String),
}

/// What a variable is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Causality {
    /// Settled before the simulation begins.
    Parameter,
    /// Set by the importing tool.
    Input,
    /// Calculated.
    Output,
}

/// A variable. Its value reference is its index in the list of its unit.
#[derive(Debug, Clone, PartialEq)]
pub struct Variable {
    /// Name, ending in the unit.
    pub name: String,
    /// Short description.
    pub description: String,
    /// What it is for.
    pub causality: Causality,
    /// Value before anything is set or calculated.
    pub start: Value,
    /// Unit, as in `hitch_input::unit`; empty for a pure number.
    pub unit: &'static str,
    /// Smallest and largest allowed value of a real number that is set.
    pub range: Option<(f64, f64)>,
}

impl Variable {
    /// An output that is a real number.
    #[must_use]
    pub fn output(name: &str, unit: &'static str, description: &str) -> Self {
        Self::new(name, Causality::Output, Value::Real(0.0), unit, description)
    }

    /// A real number that is set.
    #[must_use]
    pub fn real(
        name: &str,
        causality: Causality,
        (start, unit): (f64, &'static str),
        range: (f64, f64),
        description: &str,
    ) -> Self {
        Self {
            range: Some(range),
            ..Self::new(name, causality, Value::Real(start), unit, description)
        }
    }

    /// Any variable without a range.
    #[must_use]
    pub fn new(
        name: &str,
        causality: Causality,
        start: Value,
        unit: &'static str,
        description: &str,
    ) -> Self {
        Self {
            name: name.to_owned(),
            description: description.to_owned(),
            causality,
            start,
            unit,
            range: None,
        }
    }

    /// Whether it changes without steps.
    #[must_use]
    pub fn is_continuous(&self) -> bool {
        self.causality != Causality::Parameter && matches!(self.start, Value::Real(_))
    }

    /// Whether a real number may be set; otherwise what is wrong with it and how to correct it.
    ///
    /// # Errors
    /// If the number is not finite or outside the range.
    pub fn check(&self, value: f64) -> Result<(), String> {
        let (low, high) = self.range.unwrap_or((f64::MIN, f64::MAX));
        if (low..=high).contains(&value) {
            return Ok(());
        }
        Err(format!(
            "{} = {value}: it may be {low} to {high}; set a value in this range",
            self.name
        ))
    }
}
