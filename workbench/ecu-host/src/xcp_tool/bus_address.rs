//! Address of a CAN bus: an slcan adapter on TCP, an interface of Linux, or an slcan adapter on a serial line.

use std::fmt;
use std::io;
use std::path::Path;
use std::str::FromStr;

use hitch_output::error::Error;

/// The accepted forms, for messages.
const FORMS: &str = "give HOST:PORT of an slcan adapter, as in 127.0.0.1:7701; a CAN interface, as in can0; or a serial port, \
    as in /dev/ttyACM0 or COM3";

/// How a bus is reached.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum BusAddress {
    /// Slcan on a TCP port, as `hitch ecu --can` offers it: host and port.
    Tcp(String),
    /// A CAN interface of Linux.
    Interface(String),
    /// Slcan on a serial line.
    Serial(String),
}

impl FromStr for BusAddress {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        Self::parse(text, link_type)
    }
}

impl fmt::Display for BusAddress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (Self::Tcp(name) | Self::Interface(name) | Self::Serial(name)) = self;
        f.write_str(name)
    }
}

impl BusAddress {
    /// The fault of a bus that cannot be opened, with suggested correction.
    pub fn unreachable(&self, error: &io::Error) -> Error {
        let advice = match self {
            Self::Tcp(_) => {
                format!("start `hitch ecu --can {self}` or give the address of an slcan adapter")
            }
            Self::Serial(_) => {
                "give the port of an slcan adapter that no other program uses".to_owned()
            }
            Self::Interface(_) => {
                format!("start it with `ip link set {self} up type can bitrate 250000`")
            }
        };
        Error::Usage(format!("--can {self}: no answer: {error}; {advice}"))
    }

    /// Reads an address; `link_type` returns the type of the network interface with a name, `None` without one.
    fn parse(text: &str, link_type: impl Fn(&str) -> Option<Link>) -> Result<Self, String> {
        if let Some(address) = text.strip_prefix("tcp:") {
            return if is_host_and_port(address) {
                Ok(Self::Tcp(address.to_owned()))
            } else {
                Err(format!("`{address}` is not HOST:PORT; {FORMS}"))
            };
        }
        // Paths below /dev/serial/by-path contain colons.
        if text.starts_with(['/', '.']) || is_com_port(text) {
            return Ok(Self::Serial(text.to_owned()));
        }
        match link_type(text) {
            Some(Link::Can) => return Ok(Self::Interface(text.to_owned())),
            Some(Link::Other) => {
                return Err(format!("`{text}` is not a CAN interface; {FORMS}"));
            }
            None => {}
        }
        if is_host_and_port(text) {
            return Ok(Self::Tcp(text.to_owned()));
        }
        Err(match looks_like_interface(text) {
            true if cfg!(target_os = "linux") => {
                format!("this machine has no interface `{text}` (`ip link` lists them); {FORMS}")
            }
            true => format!("CAN interfaces such as `{text}` need Linux; {FORMS}"),
            false => format!("it is no address of a CAN bus; {FORMS}"),
        })
    }
}

/// Kind of a network interface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Link {
    Can,
    Other,
}

/// Kind of the network interface of this name; `None` if there is none.
fn link_type(name: &str) -> Option<Link> {
    /// `ARPHRD_CAN` of Linux.
    const CAN: &str = "280";
    let one_name = !name.is_empty() && !name.contains(['/', '.', ':']);
    let folder = Path::new("/sys/class/net").join(name);
    if !one_name || !cfg!(target_os = "linux") {
        return None;
    }
    match std::fs::read_to_string(folder.join("type")).ok()?.trim() {
        CAN => Some(Link::Can),
        _ => Some(Link::Other),
    }
}

fn is_host_and_port(text: &str) -> bool {
    text.rsplit_once(':')
        .is_some_and(|(host, port)| !host.is_empty() && port.parse::<u16>().is_ok())
}

fn is_com_port(text: &str) -> bool {
    has_number_after(&text.to_ascii_uppercase(), "COM")
}

fn looks_like_interface(text: &str) -> bool {
    ["can", "vcan", "slcan"]
        .iter()
        .any(|kind| has_number_after(text, kind))
}

fn has_number_after(text: &str, start: &str) -> bool {
    text.strip_prefix(start)
        .is_some_and(|number| number.parse::<u16>().is_ok())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(text: &str) -> Result<BusAddress, String> {
        BusAddress::parse(text, |name| match name {
            "can0" => Some(Link::Can),
            "eth0" => Some(Link::Other),
            _ => None,
        })
    }

    #[test]
    fn each_form_is_recognised() {
        let tcp = |text: &str| Ok(BusAddress::Tcp(text.to_owned()));
        let serial = |text: &str| Ok(BusAddress::Serial(text.to_owned()));
        assert_eq!(parsed("127.0.0.1:7701"), tcp("127.0.0.1:7701"));
        assert_eq!(parsed("tcp:bench:7701"), tcp("bench:7701"));
        assert_eq!(parsed("[::1]:7701"), tcp("[::1]:7701"));
        assert_eq!(parsed("can0"), Ok(BusAddress::Interface("can0".to_owned())));
        for port in [
            "/dev/ttyACM0",
            "/dev/serial/by-path/pci-0000:00:14.0-usb-0:1:1.0",
            "./pty",
            "COM3",
            "com12",
        ] {
            assert_eq!(parsed(port), serial(port));
        }
    }

    #[test]
    fn others_are_refused_with_all_forms() {
        for (text, reason) in [
            ("can7", "`can7`"),
            ("eth0", "not a CAN interface"),
            ("nowhere", "no address"),
            ("", "no address"),
            ("host:99999", "no address"),
            ("tcp:can0", "not HOST:PORT"),
            ("COM", "no address"),
        ] {
            let said = parsed(text).unwrap_err();
            assert!(said.contains(reason), "{text}: {said}");
            for form in ["HOST:PORT", "can0", "/dev/ttyACM0", "COM3"] {
                assert!(said.contains(form), "{text}: {said}");
            }
        }
    }
}
