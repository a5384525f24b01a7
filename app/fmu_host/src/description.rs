//! The description of a unit: `modelDescription.xml` of FMI 2.0.

use std::fmt::{self, Display, Formatter};
use std::str::FromStr;

use roxmltree::{Document, Node};

#[derive(Clone, Debug, PartialEq)]
pub struct Description {
    /// Its identity, which its library checks.
    pub guid: String,
    /// The name of its library, without the extension.
    pub library: String,
    /// Its equations, if it is made for model exchange and not for co-simulation.
    pub exchange: Option<Shape>,
    pub variables: Vec<UnitVariable>,
}

/// The size of a unit for model exchange, and how exactly it is integrated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shape {
    /// Number of continuous states.
    pub states: usize,
    /// Number of event indicators.
    pub indicators: usize,
    /// Whether the unit is told of each completed step.
    pub needs_completed_steps: bool,
    /// Relative tolerance: that of the unit's default experiment, or 1e-6.
    pub tolerance: f64,
}

impl Shape {
    const TOLERANCE: f64 = 1e-6;

    fn of(root: Node<'_, '_>, exchange: Node<'_, '_>) -> Result<Self, String> {
        let child = |name: &'static str| root.children().find(move |node| node.has_tag_name(name));
        let derivatives =
            child("ModelStructure").and_then(|it| it.children().find(|it| it.has_tag_name("Derivatives")));
        let states = derivatives.map_or(0, |it| it.children().filter(Node::is_element).count());
        let indicators = root.attribute("numberOfEventIndicators").unwrap_or("0");
        let indicators = indicators.parse().map_err(|_| "its `numberOfEventIndicators` is not a number")?;
        let tolerance = child("DefaultExperiment").and_then(|it| it.attribute("tolerance")?.parse().ok());
        Ok(Self {
            states,
            indicators,
            needs_completed_steps: exchange.attribute("completedIntegratorStepNotNeeded") != Some("true"),
            tolerance: tolerance.filter(|tolerance| *tolerance > 0.0 && *tolerance < 1.0).unwrap_or(Self::TOLERANCE),
        })
    }
}

impl Display for Shape {
    /// As the process that runs the unit reads it.
    fn fmt(&self, formatter: &mut Formatter<'_>) -> fmt::Result {
        let Self { states, indicators, needs_completed_steps, tolerance } = self;
        write!(formatter, "{states},{indicators},{needs_completed_steps},{tolerance:e}")
    }
}

impl FromStr for Shape {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts: Vec<&str> = text.split(',').collect();
        let read = || {
            let &[states, indicators, completed, tolerance] = &parts[..] else { return None };
            Some(Self {
                states: states.parse().ok()?,
                indicators: indicators.parse().ok()?,
                needs_completed_steps: completed.parse().ok()?,
                tolerance: tolerance.parse().ok()?,
            })
        };
        read().ok_or_else(|| format!("`{text}` is not states, indicators, completed steps and tolerance"))
    }
}

/// An input or an output of a unit.
#[derive(Clone, Debug, PartialEq)]
pub struct UnitVariable {
    pub name: String,
    /// Its value reference in the library.
    pub reference: u32,
    pub causality: Causality,
    pub kind: VariableKind,
    /// Its unit, such as `K`; none where it is not stated.
    pub unit: Option<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Causality {
    /// The program that runs the unit.
    Input,
    Output,
}

/// The kinds of values that this program reads and writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VariableKind {
    Real,
    /// Yes or no.
    Boolean,
}

impl Description {
    /// Reads a description. Inputs and outputs that are neither numbers nor booleans are left out.
    ///
    /// # Errors
    /// What is wrong, in words.
    pub fn parse(text: &str) -> Result<Self, String> {
        let document = Document::parse(text).map_err(|error| format!("its description is not XML: {error}"))?;
        let root = document.root_element();
        let version = root.attribute("fmiVersion").unwrap_or("none");
        if version != "2.0" {
            return Err(format!("it is of FMI version {version}; wanted is 2.0"));
        }
        let guid = root.attribute("guid").ok_or("its description has no `guid`")?;
        let kind = |name: &'static str| root.children().find(move |node| node.has_tag_name(name));
        let (simulation, exchange) = (kind("CoSimulation"), kind("ModelExchange"));
        let node = simulation.or(exchange).ok_or("it is made neither for co-simulation nor for model exchange")?;
        let exchange = if simulation.is_none() { Some(Shape::of(root, node)?) } else { None };
        if node.attribute("needsExecutionTool") == Some("true") {
            return Err("it needs the tool that exported it".to_owned());
        }
        let library = node.attribute("modelIdentifier").ok_or("its description has no `modelIdentifier`")?;
        let word = |character: char| character.is_ascii_alphanumeric() || "_-".contains(character);
        if library.is_empty() || !library.chars().all(word) {
            return Err(format!("`{library}` is not a valid name of a library"));
        }
        let variables = root.children().find(|node| node.has_tag_name("ModelVariables"));
        let types = kind("TypeDefinitions");
        let variables = variables.into_iter().flat_map(|list| list.children());
        let variables = variables.filter_map(|node| variable(node, types)).collect();
        Ok(Self { guid: guid.to_owned(), library: library.to_owned(), exchange, variables })
    }
}

/// The unit of a variable: its own, or that of its declared type.
fn unit(value: Node<'_, '_>, types: Option<Node<'_, '_>>) -> Option<String> {
    let own = value.attribute("unit").map(str::to_owned);
    own.or_else(|| {
        let declared = value.attribute("declaredType")?;
        let declared = types?.children().find(|node| node.attribute("name") == Some(declared))?;
        declared.children().find(Node::is_element)?.attribute("unit").map(str::to_owned)
    })
}

fn variable(node: Node<'_, '_>, types: Option<Node<'_, '_>>) -> Option<UnitVariable> {
    let causality = match node.attribute("causality")? {
        "input" => Causality::Input,
        "output" => Causality::Output,
        _ => return None,
    };
    let value = node.children().find(Node::is_element)?;
    let kind = match value.tag_name().name() {
        "Real" => VariableKind::Real,
        "Boolean" => VariableKind::Boolean,
        _ => return None,
    };
    Some(UnitVariable {
        name: node.attribute("name")?.to_owned(),
        reference: node.attribute("valueReference")?.parse().ok()?,
        causality,
        kind,
        unit: unit(value, types),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inputs_and_outputs_are_read_from_the_description() {
        let text = r#"<fmiModelDescription fmiVersion="2.0" guid="{1}"><CoSimulation modelIdentifier="case"/><ModelVariables>
            <ScalarVariable name="oveY_u" valueReference="3" causality="input"><Real unit="1"/></ScalarVariable>
            <ScalarVariable name="oveY_activate" valueReference="4" causality="input"><Boolean/></ScalarVariable>
            <ScalarVariable name="inner" valueReference="5" causality="local"><Real/></ScalarVariable>
            <ScalarVariable name="reaT_y" valueReference="6" causality="output"><Real unit="K"/></ScalarVariable>
            </ModelVariables></fmiModelDescription>"#;
        let found = Description::parse(text).expect("a description");
        assert_eq!((found.guid.as_str(), found.library.as_str(), found.variables.len()), ("{1}", "case", 3));
        assert_eq!((found.variables[1].kind, found.variables[1].reference), (VariableKind::Boolean, 4));
        assert_eq!(found.variables[2].unit.as_deref(), Some("K"));
    }

    #[test]
    fn model_exchange_has_the_size_of_its_equations_and_units_of_declared_types() {
        let text = r#"<fmiModelDescription fmiVersion="2.0" guid="{1}" numberOfEventIndicators="3">
            <ModelExchange modelIdentifier="case" completedIntegratorStepNotNeeded="true"/>
            <TypeDefinitions><SimpleType name="T"><Real unit="K"/></SimpleType></TypeDefinitions><DefaultExperiment tolerance="1e-9"/>
            <ModelVariables><ScalarVariable name="y" valueReference="1" causality="output"><Real declaredType="T"/></ScalarVariable>
            </ModelVariables><ModelStructure><Derivatives><Unknown index="1"/><Unknown index="2"/></Derivatives></ModelStructure>
            </fmiModelDescription>"#;
        let found = Description::parse(text).expect("a description");
        let shape = Shape { states: 2, indicators: 3, needs_completed_steps: false, tolerance: 1e-9 };
        assert_eq!((found.exchange, found.variables[0].unit.as_deref()), (Some(shape), Some("K")));
        assert_eq!(shape.to_string().parse(), Ok(shape));
        assert!("1,2".parse::<Shape>().is_err());
    }

    #[test]
    fn units_of_other_versions_and_kinds_are_refused_with_the_reason() {
        for (text, said) in [
            ("nothing", "is not XML"),
            (r#"<a fmiVersion="3.0"/>"#, "version 3.0"),
            (r#"<a fmiVersion="2.0" guid="1"/>"#, "neither for co-simulation nor for model exchange"),
            (r#"<a fmiVersion="2.0" guid="1"><CoSimulation modelIdentifier="../x"/></a>"#, "valid name of a library"),
        ] {
            let error = Description::parse(text).expect_err(text);
            assert!(error.contains(said), "{error}");
        }
    }
}
