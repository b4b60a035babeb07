//! Runs one kernel a number of times, to be counted by another program: `instruction_counts KERNEL
//! N`, or `instruction_counts list` for the names and the repeats that give a stable count.

use condyle_benches::kernels::KERNELS;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let known = match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["list"] => {
            KERNELS.iter().for_each(|kernel| println!("{} {}", kernel.name, kernel.repeats));
            true
        }
        [name, repeats] => run(name, repeats).is_some(),
        _ => false,
    };
    if known {
        return ExitCode::SUCCESS;
    }
    let names = KERNELS.map(|kernel| kernel.name).join(", ");
    eprintln!("error: give a kernel ({names}) and a number of repeats");
    ExitCode::from(2)
}

fn run(name: &str, repeats: &str) -> Option<()> {
    let kernel = KERNELS.iter().find(|kernel| kernel.name == name)?;
    (kernel.run)(repeats.parse().ok()?);
    Some(())
}
