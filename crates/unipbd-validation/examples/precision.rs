//! Prints the readings of this build, for the comparison of f32 with f64:
//! `cargo run -p unipbd-validation --no-default-features --features f64 --example precision`.

fn main() -> Result<(), unipbd_validation::Failure> {
    print!("{}", unipbd_validation::precision::lines(&unipbd_validation::precision::measure()?));
    Ok(())
}
