//! The comparator finds an injected difference, and nothing else.

use super::interface::Interface;
use replay_side::Machines;

use super::side::Side;
use super::*;

const SEED: u64 = 7;
const STEPS: u64 = 200_000;
/// Draws in which the hitch has to move.
const DRAWS: u64 = 4;

/// The present code in this process.
struct Present {
    interface: Interface,
    machines: Machines,
    answers: Vec<i32>,
}

impl Present {
    /// Machines that were just powered up.
    fn new() -> Result<Self> {
        Ok(Self {
            interface: Interface::read(&mut replay_side::description().as_bytes())?,
            machines: Machines::default(),
            answers: Vec::new(),
        })
    }
}

impl Side for Present {
    fn interface(&self) -> &Interface {
        &self.interface
    }

    fn send(&mut self, steps: &[i32]) -> Result<()> {
        self.machines.round(steps, &mut self.answers);
        Ok(())
    }

    fn receive(&mut self, _machines: usize) -> Result<Vec<i32>> {
        Ok(self.answers.clone())
    }
}

/// The present code, with 1 mA more of an output once this output is large.
struct Damaged {
    side: Present,
    output: usize,
}

impl Damaged {
    /// Largest value that is answered as it is, mA.
    const UNDAMAGED: i32 = 1_500;

    fn new(output: &str) -> Result<Self> {
        let side = Present::new()?;
        let names = &side.interface().outputs;
        let output = names.iter().position(|name| name == output).unwrap();
        Ok(Self { side, output })
    }
}

impl Side for Damaged {
    fn interface(&self) -> &Interface {
        self.side.interface()
    }

    fn send(&mut self, steps: &[i32]) -> Result<()> {
        self.side.send(steps)
    }

    fn receive(&mut self, machines: usize) -> Result<Vec<i32>> {
        let mut answers = self.side.receive(machines)?;
        let width = self.interface().outputs.len();
        for answer in answers.chunks_exact_mut(width) {
            answer[self.output] += i32::from(answer[self.output] > Self::UNDAMAGED);
        }
        Ok(answers)
    }
}

#[test]
fn the_present_code_does_not_differ_from_itself_and_the_steps_move_the_hitch() {
    // A draw has few machines: how many of its steps move the hitch differs by a factor of five.
    let mut moving = 0;
    for seed in SEED..SEED + DRAWS {
        let (mut one, mut other) = (Present::new().unwrap(), Present::new().unwrap());
        let Replay {
            differences,
            reached,
        } = random(&mut one, &mut other, seed, STEPS).unwrap();
        println!("seed {seed}: {reached:?}");
        assert_eq!(differences, Differences::default());
        assert!(reached.steps >= STEPS);
        assert!(reached.calibrations > 0, "{reached:?}");
        assert!(Reached::codes(reached.trips).len() > 5, "{reached:?}");
        moving += reached.moving;
    }
    assert!(moving > DRAWS * STEPS / 100, "{moving}");
}

#[test]
fn an_injected_difference_is_found_with_its_output_and_no_other() {
    for output in ["lower_current", "envelope.lift_current"] {
        let mut damaged = Damaged::new(output).unwrap();
        let replay = random(&mut Present::new().unwrap(), &mut damaged, SEED, STEPS).unwrap();
        let groups = replay.differences.groups;
        assert_eq!(groups.keys().collect::<Vec<_>>(), [output]);
        let group = &groups[output];
        assert!(
            group.count > 1 && group.first.contains("first in step"),
            "{group:?}"
        );
    }
}

#[test]
fn a_difference_in_the_recording_is_found() {
    let same = recorded(&mut Present::new().unwrap(), &mut Present::new().unwrap()).unwrap();
    assert_eq!(same.differences, Differences::default());
    assert!(
        same.reached.moving > same.reached.steps / 10,
        "{:?}",
        same.reached
    );
    let mut damaged = Damaged::new("lift_current").unwrap();
    let other = recorded(&mut Present::new().unwrap(), &mut damaged).unwrap();
    assert_eq!(
        other.differences.groups.keys().collect::<Vec<_>>(),
        ["lift_current"]
    );
}

#[test]
fn sides_with_other_fields_in_another_order_are_compared_by_name() {
    let text = |text: &str| Interface::read(&mut text.as_bytes()).unwrap();
    let earlier = text("input a\ninput b\noutput x\noutput y\nparameter p 5 0 9\nend\n");
    let present = text(
        "input c\ninput b\noutput z\noutput y\noutput x\nparameter q 1 0 2\nparameter p 5 2 12\nend\n",
    );
    let layout = Layout::of(&earlier, &present).unwrap();
    assert_eq!(layout.inputs, ["a", "b", "c"]);
    assert_eq!(layout.outputs, ["x", "y"]);
    assert_eq!((layout.parameters[0].min, layout.parameters[0].max), (2, 9));
    assert_eq!(layout.alone.len(), 6, "{:?}", layout.alone);
    let step = Step {
        event: Event::Calibrate,
        parameter: (0, 4),
        command: [7, 8, 9],
        inputs: vec![10, 11, 12],
    };
    let round = [step];
    assert_eq!(layout.earlier.words(&round), [2, 0, 4, 7, 8, 9, 10, 11]);
    assert_eq!(layout.present.words(&round), [2, 1, 4, 7, 8, 9, 12, 11]);
    assert_eq!(layout.earlier.common(&[1, 2]), [1, 2]);
    assert_eq!(layout.present.common(&[3, 2, 1]), [1, 2]);
}

#[test]
fn a_difference_is_explained_for_its_commit_and_its_outputs() {
    let mut differences = Differences::default();
    let group = differences::Group {
        count: 1,
        first: String::new(),
    };
    differences.groups.insert("fault, trip".to_owned(), group);
    let page = |line: &str| {
        format!(
            "# Safety\n\n{}\n\n{line}\n\n## Next\n",
            differences::SECTION
        )
    };
    let unexplained = |page: &str| differences.unexplained(page, "0123456789abcdef").len();
    assert_eq!(
        unexplained(&page("* `0123456`, `fault, trip`: a new row.")),
        0
    );
    for other in [
        "",
        "* `0123457`, `fault, trip`: another commit.",
        "* `012345`, `fault, trip`: too short.",
        "* `0123456`, `fault`: other outputs.",
    ] {
        assert_eq!(unexplained(&page(other)), 1, "{other}");
    }
    assert_eq!(
        unexplained("* `0123456`, `fault, trip`: outside of the section.\n"),
        1
    );
}
