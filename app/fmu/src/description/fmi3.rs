//! The description in FMI 3.0 (section 2.4).

use std::fmt::Write;

use super::{Description, Variable, escaped};

impl Description<'_> {
    /// The file in FMI 3.0. Its value references are those of FMI 2.0, and time comes last.
    pub(super) fn fmi3(&self) -> String {
        let variables = self.variables();
        let mut list = String::new();
        for (reference, variable) in variables.iter().enumerate() {
            let Variable { name, description, is_input, unit } = variable;
            let attributes = if *is_input {
                "causality=\"input\" variability=\"continuous\" start=\"0\""
            } else {
                "causality=\"output\" variability=\"continuous\" initial=\"calculated\""
            };
            // Writing to a text cannot fail.
            let _ = writeln!(
                list,
                "    <Float64 name=\"{}\" valueReference=\"{reference}\" description=\"{}\" unit=\"{unit}\" {attributes}/>",
                escaped(name),
                escaped(description)
            );
        }
        let references = self.zones.len()..variables.len();
        let outputs: String =
            references.clone().map(|reference| format!("    <Output valueReference=\"{reference}\"/>\n")).collect();
        let unknowns: String =
            references.map(|reference| format!("    <InitialUnknown valueReference=\"{reference}\"/>\n")).collect();
        let (title, identifier, guid, about) = (escaped(self.title), self.identifier, self.guid, self.about());
        let (step_s, stop_s, version) = (self.step_s, self.stop_s, env!("CARGO_PKG_VERSION"));
        let time = variables.len();
        format!(
            r#"<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="3.0" modelName="{title}" instantiationToken="{guid}"
    generationTool="Interplay {version}" variableNamingConvention="flat"
    description="{about}">
  <CoSimulation modelIdentifier="{identifier}" canBeInstantiatedOnlyOncePerProcess="false"
      canGetAndSetFMUState="true" canSerializeFMUState="true" providesDirectionalDerivatives="false"
      canHandleVariableCommunicationStepSize="false" fixedInternalStepSize="{step_s}" hasEventMode="false"/>
  <UnitDefinitions>
    <Unit name="s"><BaseUnit s="1"/></Unit>
    <Unit name="kW"><BaseUnit kg="1" m="2" s="-3" factor="1000"/></Unit>
    <Unit name="degC"><BaseUnit K="1" offset="273.15"/></Unit>
  </UnitDefinitions>
  <LogCategories>
    <Category name="logStatusError" description="Errors"/>
  </LogCategories>
  <DefaultExperiment startTime="0" stopTime="{stop_s}" stepSize="{step_s}"/>
  <ModelVariables>
{list}    <Float64 name="time" valueReference="{time}" description="Time since the first midnight" unit="s" causality="independent" variability="continuous"/>
  </ModelVariables>
  <ModelStructure>
{outputs}{unknowns}  </ModelStructure>
</fmiModelDescription>
"#
        )
    }
}
