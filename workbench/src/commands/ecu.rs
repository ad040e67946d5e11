//! `hitch ecu`: runs the ECU on the bench, live.
mod status_line;

use std::io::BufRead;
use std::net::SocketAddr;
use std::ops::RangeInclusive;
use std::path::PathBuf;
use std::sync::mpsc::{self, Receiver, TryRecvError};
use std::time::Instant;
use std::{io, thread};

use hitch_plant::Model;
use hitch_protocols::can::Frame;

use super::loop_::calibration;
use crate::commands::ecu::status_line::StatusLine;
use hitch_ecu_host::ecu::slcan_server::SlcanServer;
use hitch_ecu_host::ecu::{
    Bench, Bus, CutFlash, EcuMachine, FLASH_BYTES, MachineError, Order, PICK_UP_MS, Pace, Runner,
    delivered, reach_deg,
};
use hitch_ecu_host::xcp_tool::read_key;
use hitch_output::error::Error;
use hitch_output::{check_writable, no_stdout, write_file};
use hitch_results::arguments::number::{LOADS_KG, number};

/// Arguments of `hitch ecu`.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example: hitch ecu --can 127.0.0.1:7701 --load 200\n\n\
    The real firmware image runs on an emulated Cortex-M4 with the plant attached, in lock step and in real time. The \
    operator moves the lever through the hitch position (lever capture) after half a second. Standard input then takes \
    operator commands, one in each line: lever DEG, up, down, stop, quick on|off, hold on|off, lock on|off, \
    service on|off, consent on|off, limit DEG, dial PERCENT, power, quit. Lever and limit move over the travel of the model's hitch and \
    10 degrees more, as far as the board's sensors measure it (35 to 145 degrees). The status shows when the computer is too slow for real time. With --can, the bus accepts slcan clients: python-can with \
    interface slcan and channel socket://HOST:PORT. Writing the calibration over XCP requires `service on`.")]
pub struct Args {
    /// Offer the CAN bus as slcan on this TCP port
    #[arg(long, value_name = "HOST:PORT")]
    can: Option<String>,
    /// The plant: nominal, dynamic, or the name of a model file
    #[arg(long, value_name = "MODEL", default_value = "dynamic")]
    model: String,
    /// Load at the hitch, kg; without this option, 9 % of what the model can lift, 150 for the paper's
    #[arg(long, value_name = "KG", allow_negative_numbers = true, value_parser = number(LOADS_KG))]
    load: Option<f64>,
    /// Calibration of the ECU as delivered; without this option, the nominal one
    #[arg(long, value_name = "C.toml")]
    calibration: Option<PathBuf>,
    /// Keep the ECU's flash in this file, with taught and tuned values
    #[arg(long, value_name = "FILE")]
    flash: Option<PathBuf>,
    /// Key of the ECU as delivered, a file with 64 hexadecimal digits; without one, safety values are never loosened
    #[arg(long, value_name = "FILE")]
    key: Option<PathBuf>,
    /// End after this many seconds
    #[arg(long, value_name = "S", value_parser = number(0.0..=86_400.0))]
    seconds: Option<f64>,
    /// Image of the emulated ECU; without this option, it is built from the sources
    #[arg(long, value_name = "FILE", conflicts_with = "host")]
    image: Option<PathBuf>,
    /// Run the application on the host instead of the emulated processor
    #[arg(long)]
    host: bool,
}

/// Runs the command.
///
/// # Errors
/// If an input is invalid or missing, or the emulator ends.
pub fn run(args: &Args) -> Result<(), Error> {
    // The file is both read and written.
    no_stdout(
        "--flash",
        args.flash.as_deref(),
        "the file is read at the next start",
    )?;
    args.flash.as_deref().map_or(Ok(()), check_writable)?;
    let model = hitch_model_file::named(&args.model)?;
    let flash = flash(args)?;
    let server = args.can.as_deref().map(open_slcan_server).transpose()?;
    let mut session = Session::new(&model, args, server);
    let runner = if args.host {
        Runner::Host
    } else {
        Runner::emulator(args.image.as_deref())?
    };
    let mut machine = runner.power_up(flash).map_err(failed)?;
    let result = session.run(&mut machine);
    let flash = machine.power_off().map_err(failed)?;
    let kept = args.flash.as_deref();
    kept.map_or(Ok(()), |path| write_file(path, &flash))?;
    result
}

fn failed(error: impl std::fmt::Display) -> Error {
    Error::Failed(error.to_string())
}

/// Initial contents of the ECU's flash.
fn flash(args: &Args) -> Result<Vec<u8>, Error> {
    let key = args.key.as_deref().map(read_key).transpose()?;
    let flash = CutFlash::holding(flash_without_key(args)?);
    if let Some(key) = key {
        flash.set_key(&key);
    }
    Ok(flash.bytes())
}

fn flash_without_key(args: &Args) -> Result<Vec<u8>, Error> {
    let delivered = delivered(&calibration(args.calibration.as_ref())?);
    let Some(path) = args.flash.as_deref().filter(|path| path.exists()) else {
        return Ok(delivered);
    };
    match std::fs::read(path) {
        Ok(bytes) if bytes.len() == FLASH_BYTES => Ok(bytes),
        Ok(bytes) => Err(Error::Usage(format!(
            "{}: is not the flash of an ECU ({} bytes instead of {FLASH_BYTES}); give a file written by `hitch ecu --flash`, or a new file",
            path.display(),
            bytes.len()
        ))),
        Err(error) => Err(Error::Usage(format!(
            "{}: cannot be read: {error}; give a file used only for the flash",
            path.display()
        ))),
    }
}

fn open_slcan_server(address: &str) -> Result<SlcanServer, Error> {
    SlcanServer::open(address).map_err(|error| {
        Error::Usage(format!(
            "--can {address}: cannot be opened: {error}; give an address of this machine and a free port, as in 127.0.0.1:7701"
        ))
    })
}

/// Commands from standard input, as they arrive.
fn orders() -> Receiver<String> {
    let (sender, receiver) = mpsc::channel();
    thread::spawn(move || {
        for line in io::stdin().lock().split(b'\n').map_while(Result::ok) {
            // Bytes that are not UTF-8 become U+FFFD, which no command contains: the line is rejected, and reading
            // continues.
            let line = String::from_utf8_lossy(&line).into_owned();
            if sender.send(line).is_err() {
                return;
            }
        }
    });
    receiver
}

/// The bench, its operator, and the duration.
struct Session<'m> {
    bench: Bench<'m>,
    /// Address of the bus for clients.
    address: Option<SocketAddr>,
    bus: Option<Bus>,
    status: StatusLine,
    last_ms: u64,
    /// Angle of the hitch at the start, the middle of its travel, degree.
    start_deg: f64,
    /// Range of lever and upper-limit dial, degree.
    reach_deg: RangeInclusive<f64>,
}

impl<'m> Session<'m> {
    fn new(model: &'m Model, args: &Args, server: Option<SlcanServer>) -> Self {
        /// Oil temperature of the rig's data, C.
        const OIL_TEMPERATURE_C: f64 = 40.0;
        let address = server.as_ref().and_then(|server| server.address().ok());
        let (low_rad, high_rad) = model.linkage().swing_rad();
        let start_deg = (0.5 * (low_rad + high_rad)).to_degrees().round();
        let load_kg = args.load.unwrap_or(model.usual_loads_kg()[1]);
        Self {
            address,
            start_deg,
            reach_deg: reach_deg(model),
            bench: Bench::new(model, load_kg, OIL_TEMPERATURE_C, start_deg, 1),
            bus: server.map(Bus::served_by),
            status: StatusLine::start(),
            last_ms: args
                .seconds
                .map_or(u64::MAX, |seconds| (seconds * 1e3) as u64),
        }
    }

    /// Runs in real time until the duration has passed or the operator quits.
    fn run(&mut self, machine: &mut impl EcuMachine) -> Result<(), Error> {
        // The bus opens when the ECU answers: a build of the image before that would exceed the timeout of clients.
        if let Some(address) = self.address {
            eprintln!("CAN is open: slcan on {address}");
        }
        let orders = orders();
        let mut said: Vec<Frame> = Vec::new();
        let mut pace = None;
        for time_ms in 0..self.last_ms {
            if time_ms == PICK_UP_MS {
                self.bench.operator.apply(Order::Lever(self.start_deg));
            }
            if !self.take_orders(&orders, machine)? {
                break;
            }
            let received = self.bus.as_mut().map(Bus::receive).unwrap_or_default();
            said.clear();
            let moment = self.bench.tick(machine, &received, &mut said);
            let moment = moment.map_err(|error: MachineError| failed(error))?;
            let clients = self.bus.as_mut().map(|bus| {
                bus.send(&said);
                bus.connected()
            });
            self.status.show(&moment, clients).map_err(Error::Stdout)?;
            // The first millisecond includes the start of the emulator.
            let now = Instant::now();
            let pace = pace.get_or_insert_with(|| Pace::starting(now));
            let (wait, change) = pace.tick(now);
            change
                .into_iter()
                .for_each(|change| self.status.tell(change));
            thread::sleep(wait);
        }
        Ok(())
    }

    /// Executes the operator's command; false if it ends the program.
    fn take_orders(
        &mut self,
        orders: &Receiver<String>,
        machine: &mut impl EcuMachine,
    ) -> Result<bool, Error> {
        loop {
            let line = match orders.try_recv() {
                Ok(line) => line,
                Err(TryRecvError::Empty | TryRecvError::Disconnected) => return Ok(true),
            };
            match Order::parse(&line, &self.reach_deg) {
                _ if line.trim().is_empty() => {}
                Ok(Order::Quit) => return Ok(false),
                Ok(Order::Power) => machine.power_cycle().map_err(failed)?,
                Ok(order) => self.bench.operator.apply(order),
                // An invalid command does not end the program.
                Err(what) => self.status.say(&what),
            }
        }
    }
}
