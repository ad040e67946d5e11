//! The NAME of a node: its identity and its priority in address claims (SAE J1939-81, ISO 11783-5).

/// The 64 bits of a NAME. The smaller one has priority.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Name(pub u64);

/// The fields of a NAME.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NameFields {
    /// Serial number of the unit, 21 bits.
    pub identity: u32,
    /// Code of the manufacturer, 11 bits, assigned by SAE.
    pub manufacturer: u16,
    /// Instance of a unit among those of one function, 3 bits.
    pub ecu_instance: u8,
    /// Instance of the function, 5 bits.
    pub function_instance: u8,
    /// Function; 130 is control of the rear hitch.
    pub function: u8,
    /// Device class, 7 bits; 1 is a tractor.
    pub device_class: u8,
    /// Instance of the device, 4 bits.
    pub device_class_instance: u8,
    /// Industry group, 3 bits; 2 is agriculture and forestry.
    pub industry_group: u8,
    /// Whether it claims another address when it loses its own.
    pub self_configurable: bool,
}

impl NameFields {
    /// The rear hitch of a tractor with this serial number.
    ///
    /// The manufacturer code is 0, "reserved"; a manufacturer sets its own.
    #[must_use]
    pub const fn rear_hitch(identity: u32) -> Self {
        Self {
            identity,
            manufacturer: 0,
            ecu_instance: 0,
            function_instance: 0,
            function: 130,
            device_class: 1,
            device_class_instance: 0,
            industry_group: 2,
            self_configurable: true,
        }
    }
}

impl From<NameFields> for Name {
    fn from(fields: NameFields) -> Self {
        let part = |value: u64, bits: u32, at: u32| (value & ((1 << bits) - 1)) << at;
        let parts = [
            part(fields.identity.into(), 21, 0),
            part(fields.manufacturer.into(), 11, 21),
            part(fields.ecu_instance.into(), 3, 32),
            part(fields.function_instance.into(), 5, 35),
            part(fields.function.into(), 8, 40),
            part(fields.device_class.into(), 7, 49),
            part(fields.device_class_instance.into(), 4, 56),
            part(fields.industry_group.into(), 3, 60),
            part(fields.self_configurable.into(), 1, 63),
        ];
        Self(parts.into_iter().fold(0, core::ops::BitOr::bitor))
    }
}

impl Name {
    /// Whether the node may claim another address.
    #[must_use]
    pub const fn is_self_configurable(self) -> bool {
        self.0 >> 63 == 1
    }

    /// Device class, 7 bits.
    const fn device_class(self) -> u8 {
        (self.0 >> 49) as u8 & 0x7F
    }

    /// Industry group, 3 bits.
    const fn industry_group(self) -> u8 {
        (self.0 >> 60) as u8 & 0x07
    }

    /// Whether the node belongs to an implement: industry group 2, agriculture and forestry, and a device class that is
    /// neither 0, non-specific, nor 1, tractor, nor 127, not available. Nodes of these classes (terminals, task
    /// controllers, guidance, engines, service tools) are not what hangs on the hitch, and no function of a tractor
    /// commands a hitch as an implement does.
    #[must_use]
    pub const fn is_implement(self) -> bool {
        const AGRICULTURE: u8 = 2;
        self.industry_group() == AGRICULTURE && !matches!(self.device_class(), 0 | 1 | 0x7F)
    }

    /// As in a message.
    #[must_use]
    pub const fn to_bytes(self) -> [u8; 8] {
        self.0.to_le_bytes()
    }

    /// From a message.
    #[must_use]
    pub const fn from_bytes(bytes: [u8; 8]) -> Self {
        Self(u64::from_le_bytes(bytes))
    }
}
