//! The binary `visavis`: see the library of the same name.

fn main() -> std::process::ExitCode {
    visavis::environment::settle();
    visavis::run(std::env::args_os().skip(1))
}
