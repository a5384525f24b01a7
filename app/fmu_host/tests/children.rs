//! Every behaviour of the unit's process gives an answer or an error in time. Shell scripts replace the process, so no unit has to crash.
#![cfg(all(target_os = "linux", target_arch = "x86_64"))]

mod units;

use std::path::Path;
use std::time::{Duration, Instant};

use interplay_fmu_host::{Host, HostError, HostProgram, Request, Unit};
use units::unit;

const DESCRIPTION: &str = r#"<fmiModelDescription fmiVersion="2.0" guid="{1}"><CoSimulation modelIdentifier="case"/>
    <ModelVariables/></fmiModelDescription>"#;

fn sound(folder: &Path) -> Unit {
    let files = [("modelDescription.xml", DESCRIPTION.as_bytes()), ("binaries/linux64/case.so", b"no library")];
    unit(folder, &files).expect("a unit")
}

fn shell(script: &str) -> HostProgram {
    HostProgram { program: "sh".into(), arguments: vec!["-c".into(), script.into()] }
}

#[test]
fn crashes_and_malformed_answers_are_errors() {
    let folder = tempfile::tempdir().expect("a folder");
    let unit = sound(folder.path());
    let done = r#"echo '{"answer":"done"}'; read line; "#;
    for (script, said) in [
        (
            "echo 'no such symbol' >&2; exit 7".to_owned(),
            "`instantiate`: its process ended with exit code 7, after it wrote `no such symbol`",
        ),
        (
            r"printf 'ung\374ltig\r\nno licence\r\n' >&2; exit 7".to_owned(),
            "`instantiate`: its process ended with exit code 7, after it wrote `no licence`",
        ),
        ("kill -SEGV $$".to_owned(), "signal 11"),
        (format!("{done} kill -SEGV $$"), "`initialize`: its process ended with signal 11"),
        (format!("{done} echo hello"), "answers `hello`"),
        (format!(r#"{done} echo '{{"answer":"failed","reason":"the solver stopped"}}'"#), "the solver stopped"),
    ] {
        let asked = Host::start(&shell(&script), &unit, Duration::from_secs(20))
            .and_then(|mut host| host.ask(&Request::Initialize { start_s: 0.0 }));
        let error = asked.map(|_| ()).expect_err(&script).to_string();
        assert!(error.contains(said), "{script}: {error}");
    }
    let missing = HostProgram { program: "/no/such/program".into(), arguments: Vec::new() };
    let error = Host::start(&missing, &unit, Duration::from_secs(1)).map(|_| ()).expect_err("nothing there");
    assert!(matches!(error, HostError::Start { .. }), "{error}");
}

#[test]
fn a_process_that_keeps_the_standard_error_open_does_not_delay_the_error_of_a_crash() {
    let folder = tempfile::tempdir().expect("a folder");
    let unit = sound(folder.path());
    let began = Instant::now();
    let script = "echo 'no licence' >&2; sleep 60 > /dev/null & exit 7";
    let error = Host::start(&shell(script), &unit, Duration::from_secs(50)).map(|_| ()).expect_err("it ends");
    assert!(error.to_string().contains("exit code 7, after it wrote `no licence`"), "{error}");
    assert!(began.elapsed() < Duration::from_secs(40));
}

#[test]
fn a_unit_that_hangs_is_stopped_at_the_timeout() {
    let folder = tempfile::tempdir().expect("a folder");
    let unit = sound(folder.path());
    let began = Instant::now();
    let script = r#"echo '{"answer":"done"}'; echo 'no convergence' >&2; exec sleep 600"#;
    let mut host = Host::start(&shell(script), &unit, Duration::from_secs(2)).expect("it starts");
    let error = host.ask(&Request::Reset).map(|_| ()).expect_err("it hangs").to_string();
    assert!(error.contains("no answer to `reset` within 2 s, after it wrote `no convergence`"), "{error}");
    drop(host);
    assert!(began.elapsed() < Duration::from_secs(20));
}

#[test]
fn files_that_are_not_units_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let description = ("modelDescription.xml", DESCRIPTION.as_bytes());
    let refused = |files: &[(&str, &[u8])]| unit(folder.path(), files).map(|_| ()).expect_err("refused").to_string();
    assert!(refused(&[]).contains("no `modelDescription.xml`"));
    let windows = refused(&[description, ("binaries/win64/case.dll", b"")]);
    assert!(windows.contains("no `binaries/linux64/case.so`") && windows.contains("win64"), "{windows}");
    let outside = [description, ("binaries/linux64/case.so", b""), ("../outside", b"x")];
    assert!(refused(&outside).contains("would lie elsewhere"));
    assert!(!folder.path().parent().expect("a parent").join("outside").exists());
    let error = Unit::open(&folder.path().join("missing.fmu")).map(|_| ()).expect_err("missing");
    assert!(matches!(error, HostError::Read { .. }), "{error}");
}
