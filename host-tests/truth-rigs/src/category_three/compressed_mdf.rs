//! A log as MDF 4.1 (ASAM) with deflated data, with groups of channels.

/// Channels that were sampled together.
pub struct Group {
    /// Times, s.
    pub time_s: Vec<f64>,
    /// Name, unit and values of each channel.
    pub channels: Vec<(&'static str, &'static str, Vec<f64>)>,
}

/// The bytes of a file with these groups.
#[must_use]
pub fn bytes(groups: &[Group]) -> Vec<u8> {
    let mut file = Blocks::default();
    file.bytes.extend(*b"MDF     4.10    logger  ");
    file.bytes.extend([0; 4]);
    file.bytes.extend(410_u16.to_le_bytes());
    file.bytes.resize(64, 0);
    // The header stands at byte 64 and links to the first data group; its links are patched.
    let times = [
        1_795_600_000_000_000_000_u64.to_le_bytes(),
        [0; 8],
        [0; 8],
        [0; 8],
    ]
    .concat();
    let header = file.block(*b"##HD", &[0; 6], &times);
    let history = file.block(*b"##FH", &[0; 2], &[0; 16]);
    let mut first = 0;
    for group in groups.iter().rev() {
        first = file.group(group, first);
    }
    file.link(header, 0, first);
    file.link(header, 1, history);
    file.bytes
}

#[derive(Default)]
struct Blocks {
    bytes: Vec<u8>,
}

impl Blocks {
    /// Appends a block and returns its address.
    fn block(&mut self, id: [u8; 4], links: &[u64], data: &[u8]) -> u64 {
        self.bytes.resize(self.bytes.len().next_multiple_of(8), 0);
        let address = self.bytes.len() as u64;
        let length = 24 + 8 * links.len() + data.len();
        self.bytes.extend(id);
        self.bytes.extend([0; 4]);
        self.bytes.extend((length as u64).to_le_bytes());
        self.bytes.extend((links.len() as u64).to_le_bytes());
        self.bytes
            .extend(links.iter().flat_map(|link| link.to_le_bytes()));
        self.bytes.extend(data);
        address
    }

    /// Sets a link of a block.
    fn link(&mut self, block: u64, index: usize, to: u64) {
        let at = block as usize + 24 + 8 * index;
        self.bytes[at..at + 8].copy_from_slice(&to.to_le_bytes());
    }

    fn text(&mut self, text: &str) -> u64 {
        let mut data = text.as_bytes().to_vec();
        data.resize((data.len() + 1).next_multiple_of(8), 0);
        self.block(*b"##TX", &[], &data)
    }

    /// Appends a data group that links to the next one.
    fn group(&mut self, group: &Group, next: u64) -> u64 {
        let mut after = 0;
        let named = group.channels.iter().enumerate().rev();
        for (index, (name, unit, _)) in named {
            let at = 8 + 4 * index as u32;
            after = self.channel([*name, *unit], [0, 0], at, 32, after);
        }
        let master = self.channel(["time", "s"], [2, 1], 0, 64, after);
        let record = 8 + 4 * group.channels.len() as u32;
        let mut about = Vec::new();
        about.extend(0_u64.to_le_bytes());
        about.extend((group.time_s.len() as u64).to_le_bytes());
        about.extend([0; 8]);
        about.extend(record.to_le_bytes());
        about.extend([0; 4]);
        let channels = self.block(*b"##CG", &[0, master, 0, 0, 0, 0], &about);
        let data = self.deflated(group);
        self.block(*b"##DG", &[next, channels, data, 0], &[0; 8])
    }

    /// Appends a channel of floating-point numbers: `[type, synchronisation]`, byte in the record, bits.
    fn channel(
        &mut self,
        [name, unit]: [&str; 2],
        kind: [u8; 2],
        at: u32,
        bits: u32,
        next: u64,
    ) -> u64 {
        const LITTLE_ENDIAN_FLOAT: u8 = 4;
        let (name, unit) = (self.text(name), self.text(unit));
        let mut about = vec![kind[0], kind[1], LITTLE_ENDIAN_FLOAT, 0];
        about.extend(at.to_le_bytes());
        about.extend(bits.to_le_bytes());
        about.resize(72, 0);
        self.block(*b"##CN", &[next, 0, name, 0, 0, 0, unit, 0], &about)
    }

    /// Appends the records of a group, deflated.
    fn deflated(&mut self, group: &Group) -> u64 {
        let mut records = Vec::new();
        for (row, time_s) in group.time_s.iter().enumerate() {
            records.extend(time_s.to_le_bytes());
            for (_, _, values) in &group.channels {
                records.extend((values[row] as f32).to_le_bytes());
            }
        }
        let packed = miniz_oxide::deflate::compress_to_vec_zlib(&records, 6);
        let mut data = b"DT\0\0".to_vec();
        data.extend(0_u32.to_le_bytes());
        data.extend((records.len() as u64).to_le_bytes());
        data.extend((packed.len() as u64).to_le_bytes());
        data.extend(packed);
        self.block(*b"##DZ", &[], &data)
    }
}
