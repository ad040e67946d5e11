//! `replay-side`: prints its interface, then answers rounds of steps: a word with the number of machines, and a step of
//! each, in little-endian words.

use std::io::{self, Read, Write};

use replay_side::{Machines, STEP_WORDS, description};

/// More machines in a round than this are a damaged stream.
const MOST_MACHINES: usize = 65_536;

fn main() -> io::Result<()> {
    let (mut input, mut output) = (io::stdin().lock(), io::stdout().lock());
    output.write_all(description().as_bytes())?;
    output.flush()?;
    let mut machines = Machines::default();
    let mut bytes = Vec::new();
    let (mut steps, mut answers) = (Vec::new(), Vec::new());
    let mut count = [0; 4];
    loop {
        match input.read_exact(&mut count) {
            Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => return Ok(()),
            read => read?,
        }
        let count = u32::from_le_bytes(count) as usize;
        if count > MOST_MACHINES {
            return Err(io::Error::other(format!("a round of {count} machines")));
        }
        bytes.resize(4 * STEP_WORDS * count, 0);
        input.read_exact(&mut bytes)?;
        steps.clear();
        steps.extend(
            bytes
                .as_chunks::<4>()
                .0
                .iter()
                .map(|word| i32::from_le_bytes(*word)),
        );
        machines.round(&steps, &mut answers);
        bytes.clear();
        bytes.extend(answers.iter().flat_map(|word| word.to_le_bytes()));
        output.write_all(&bytes)?;
        output.flush()?;
    }
}
