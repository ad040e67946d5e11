//! Codes of commands, answers and events (ASAM MCD-1 XCP, protocol layer).

/// Packet identifiers of the slave; samples have the numbers below.
pub(super) mod identifier {
    pub const RESPONSE: u8 = 0xFF;
    pub const ERROR: u8 = 0xFE;
    pub const EVENT: u8 = 0xFD;
}

/// Events that the slave reports.
pub(super) mod event {
    pub const STORED: u8 = 0x03;
    pub const OVERLOAD: u8 = 0x06;
    /// User-defined: storing failed.
    pub const NOT_STORED: u8 = 0xFE;
}

/// Commands.
pub(super) mod code {
    pub const CONNECT: u8 = 0xFF;
    pub const DISCONNECT: u8 = 0xFE;
    pub const GET_STATUS: u8 = 0xFD;
    pub const SYNCH: u8 = 0xFC;
    pub const GET_COMM_MODE_INFO: u8 = 0xFB;
    pub const GET_ID: u8 = 0xFA;
    pub const SET_REQUEST: u8 = 0xF9;
    pub const GET_SEED: u8 = 0xF8;
    pub const UNLOCK: u8 = 0xF7;
    pub const SET_MTA: u8 = 0xF6;
    pub const UPLOAD: u8 = 0xF5;
    pub const SHORT_UPLOAD: u8 = 0xF4;
    pub const BUILD_CHECKSUM: u8 = 0xF3;
    pub const DOWNLOAD: u8 = 0xF0;
    pub const DOWNLOAD_MAX: u8 = 0xEE;
    pub const SET_CAL_PAGE: u8 = 0xEB;
    pub const GET_CAL_PAGE: u8 = 0xEA;
    pub const GET_PAG_PROCESSOR_INFO: u8 = 0xE9;
    pub const GET_SEGMENT_INFO: u8 = 0xE8;
    pub const GET_PAGE_INFO: u8 = 0xE7;
    pub const COPY_CAL_PAGE: u8 = 0xE4;
    pub const SET_DAQ_PTR: u8 = 0xE2;
    pub const WRITE_DAQ: u8 = 0xE1;
    pub const SET_DAQ_LIST_MODE: u8 = 0xE0;
    pub const GET_DAQ_LIST_MODE: u8 = 0xDF;
    pub const START_STOP_DAQ_LIST: u8 = 0xDE;
    pub const START_STOP_SYNCH: u8 = 0xDD;
    pub const GET_DAQ_CLOCK: u8 = 0xDC;
    pub const READ_DAQ: u8 = 0xDB;
    pub const GET_DAQ_PROCESSOR_INFO: u8 = 0xDA;
    pub const GET_DAQ_RESOLUTION_INFO: u8 = 0xD9;
    pub const GET_DAQ_EVENT_INFO: u8 = 0xD7;
    pub const FREE_DAQ: u8 = 0xD6;
    pub const ALLOC_DAQ: u8 = 0xD5;
    pub const ALLOC_ODT: u8 = 0xD4;
    pub const ALLOC_ODT_ENTRY: u8 = 0xD3;
}
