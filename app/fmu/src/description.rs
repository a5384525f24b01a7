//! `modelDescription.xml`: what an importer is told of the variables (FMI 2.0, section 2.2).

use std::fmt::Write;

use interplay_building::network::PowerLimits;

/// What is described.
#[derive(Clone, Debug)]
pub(crate) struct Description<'a> {
    /// The title of the scenario.
    pub title: &'a str,
    /// The name of the library.
    pub identifier: &'a str,
    /// The identity, which the resources repeat.
    pub guid: &'a str,
    /// The names of the zones.
    pub zones: &'a [String],
    /// What the equipment of each zone can give.
    pub limits: &'a PowerLimits,
    /// Time from one step to the next \[s\].
    pub step_s: f64,
    /// End of the weather \[s\].
    pub stop_s: f64,
}

/// What a variable is.
struct Variable {
    name: String,
    description: String,
    attributes: &'static str,
    real: String,
}

impl Description<'_> {
    /// The file.
    pub(crate) fn xml(&self) -> String {
        let variables = self.variables();
        let mut lists = String::new();
        for (reference, variable) in variables.iter().enumerate() {
            let Variable { name, description, attributes, real } = variable;
            // Writing to a text cannot fail.
            let _ = writeln!(
                lists,
                "    <ScalarVariable name=\"{}\" valueReference=\"{reference}\" description=\"{}\" {attributes}>\n      \
                 <Real {real}/>\n    </ScalarVariable>",
                escaped(name),
                escaped(description)
            );
        }
        let outputs: String = (self.zones.len() + 1..=variables.len())
            .map(|index| format!("      <Unknown index=\"{index}\"/>\n"))
            .collect();
        let (title, identifier, guid) = (escaped(self.title), self.identifier, self.guid);
        let (step_s, stop_s, version) = (self.step_s, self.stop_s, env!("CARGO_PKG_VERSION"));
        format!(
            r#"<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="{title}" guid="{guid}" generationTool="Interplay {version}"
    variableNamingConvention="flat" numberOfEventIndicators="0"
    description="A thermal network with its weather. Heat is held between steps; steps are whole multiples of {step_s} s.">
  <CoSimulation modelIdentifier="{identifier}" canHandleVariableCommunicationStepSize="false"
      canInterpolateInputs="false" canNotUseMemoryManagementFunctions="true" canGetAndSetFMUstate="false"
      providesDirectionalDerivative="false"/>
  <UnitDefinitions>
    <Unit name="kW"><BaseUnit kg="1" m="2" s="-3" factor="1000"/></Unit>
    <Unit name="degC"><BaseUnit K="1" offset="273.15"/></Unit>
  </UnitDefinitions>
  <LogCategories>
    <Category name="logStatusError" description="Errors"/>
  </LogCategories>
  <DefaultExperiment startTime="0" stopTime="{stop_s}" stepSize="{step_s}"/>
  <ModelVariables>
{lists}  </ModelVariables>
  <ModelStructure>
    <Outputs>
{outputs}    </Outputs>
    <InitialUnknowns>
{outputs}    </InitialUnknowns>
  </ModelStructure>
</fmiModelDescription>
"#
        )
    }

    /// The variables in the order of their value references (`library/instance.rs`).
    fn variables(&self) -> Vec<Variable> {
        const OUTPUT: &str = "causality=\"output\" variability=\"continuous\" initial=\"calculated\"";
        let PowerLimits { heating_kw, cooling_kw } = self.limits;
        let heat = |(index, zone): (usize, &String)| Variable {
            name: format!("{zone}.heat"),
            description: format!(
                "Heat of the equipment of {zone}, at most {} kW; negative when it cools, at most {} kW",
                heating_kw[index], cooling_kw[index]
            ),
            attributes: "causality=\"input\" variability=\"continuous\"",
            real: "unit=\"kW\" start=\"0\"".to_owned(),
        };
        let temperature = |zone: &String| Variable {
            name: format!("{zone}.temperature"),
            description: format!("Temperature of {zone}"),
            attributes: OUTPUT,
            real: "unit=\"degC\"".to_owned(),
        };
        let gains = |zone: &String| Variable {
            name: format!("{zone}.gains"),
            description: format!("Heat of people, machines and sun in {zone}, until the next step"),
            attributes: OUTPUT,
            real: "unit=\"kW\"".to_owned(),
        };
        let outdoor = Variable {
            name: "outdoor temperature".to_owned(),
            description: "Temperature outdoors, until the next step".to_owned(),
            attributes: OUTPUT,
            real: "unit=\"degC\"".to_owned(),
        };
        let heats = self.zones.iter().enumerate().map(heat);
        let temperatures = self.zones.iter().map(temperature);
        heats.chain(temperatures).chain(self.zones.iter().map(gains)).chain([outdoor]).collect()
    }
}

/// A text within an attribute. Characters that XML does not allow become question marks.
fn escaped(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            '\u{FFFE}' | '\u{FFFF}' => safe.push('?'),
            _ if character.is_control() => safe.push('?'),
            _ => safe.push(character),
        }
    }
    safe
}
