//! Running other programs.

use crate::outcome::Context;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Runs a command, which inherits our output.
pub(crate) fn run(context: &Context, command: &mut Command) -> Result<(), String> {
    let shown = shown(command);
    println!("   {shown}");
    if context.trial.is_some() {
        let output = command.output().map_err(|error| format!("`{shown}`: {error}"))?;
        let said = [output.stderr, output.stdout].concat();
        return if output.status.success() {
            Ok(())
        } else {
            let said = String::from_utf8_lossy(&said).into_owned();
            Err(format!("`{shown}` ended with {}\n{said}", output.status))
        };
    }
    match command.status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("`{shown}` ended with {status}")),
        Err(error) => Err(format!("`{shown}`: {error}")),
    }
}

/// Runs a command that may hang, with a time limit.
pub(crate) fn run_within(limit: Duration, command: &mut Command) -> Result<(), String> {
    let shown = shown(command);
    println!("   {shown}");
    let start = Instant::now();
    let mut child = command.spawn().map_err(|error| format!("`{shown}`: {error}"))?;
    loop {
        match child.try_wait() {
            Ok(Some(status)) if status.success() => return Ok(()),
            Ok(Some(status)) => return Err(format!("`{shown}` ended with {status}")),
            Ok(None) if start.elapsed() < limit => {
                std::thread::sleep(Duration::from_millis(50));
            }
            Ok(None) => {
                // It may have ended by itself a moment ago; either way it is gone after `wait`.
                let _ = child.kill();
                let _ = child.wait();
                return Err(format!("`{shown}` took more than {} s", limit.as_secs()));
            }
            Err(error) => return Err(format!("`{shown}`: {error}")),
        }
    }
}

/// The standard output of a command.
pub(crate) fn output(context: &Context, command: &mut Command) -> Result<String, String> {
    let shown = shown(command);
    if context.trial.is_none() {
        command.stderr(Stdio::inherit());
    }
    let output = command.output().map_err(|error| format!("`{shown}`: {error}"))?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        return Err(format!("`{shown}` ended with {}\n{said}", output.status).trim_end().into());
    }
    String::from_utf8(output.stdout).map_err(|_| format!("`{shown}` did not answer with text"))
}

/// Whether a program is installed and accepts `--version`.
pub(crate) fn is_installed(command: &mut Command) -> bool {
    command.arg("--version").stdout(Stdio::null()).stderr(Stdio::null());
    command.status().is_ok_and(|status| status.success())
}

fn shown(command: &Command) -> String {
    let program = PathBuf::from(command.get_program());
    let name = program.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let arguments = command.get_args().map(|argument| argument.to_string_lossy().into_owned());
    std::iter::once(name).chain(arguments).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[cfg(unix)]
    fn what_hangs_is_ended() {
        let start = Instant::now();
        let limit = Duration::from_millis(100);
        let answer = run_within(limit, Command::new("sleep").arg("60"));
        assert_eq!(answer, Err("`sleep 60` took more than 0 s".to_owned()));
        assert!(start.elapsed() < Duration::from_secs(30));
        assert_eq!(run_within(Duration::from_secs(30), &mut Command::new("true")), Ok(()));
        assert!(run_within(Duration::from_secs(30), &mut Command::new("false")).is_err());
    }
}
