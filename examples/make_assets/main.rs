//! Makes the models in `assets/` that the stock scenes are composed of.
//!
//! `cargo run --example make_assets` writes them all; `tests/assets.rs` checks that the committed
//! files are what this program makes, byte for byte. So that they are the same on every host, all
//! arithmetic is f64 addition, multiplication, division and square roots, which IEEE 754 rounds
//! one way only; sines come from `models::math`, not from the host's library.

mod models;

use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets");
    let mut total = 0;
    for (name, bytes) in models::all() {
        let path = folder.join(name);
        if let Err(error) = std::fs::create_dir_all(&folder).and_then(|()| std::fs::write(&path, &bytes)) {
            eprintln!("cannot write {}: {error}", path.display());
            return ExitCode::FAILURE;
        }
        println!("{:>8} bytes  {name}", bytes.len());
        total += bytes.len();
    }
    println!("{total:>8} bytes  together");
    ExitCode::SUCCESS
}
