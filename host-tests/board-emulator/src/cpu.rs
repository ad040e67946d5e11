//! The processor: Unicorn's Cortex-M4, loaded at run time from its Python package.
//!
//! Unicorn is licensed under GPL-2.0. It is a test tool: nothing in this workspace links against it, and only the
//! program `board-bench` loads it, in a process of its own.

use std::ffi::{c_int, c_uint, c_void};
use std::path::Path;
use std::ptr;

use anyhow::{Context, Result, ensure};
use libloading::Library;

use super::block_counts::{BlockCounts, instructions};

/// Unicorn's constants (`unicorn.h`, `arm.h`, version 2.1).
const ARCHITECTURE_ARM: c_uint = 1;
const MODE_THUMB_M_CLASS: c_uint = (1 << 4) | (1 << 5);
const CORTEX_M4: c_int = 9;
/// `UC_CTL_WRITE(UC_CTL_CPU_MODEL, 1)`.
const SET_CPU_MODEL: c_uint = 7 | (1 << 26) | (1 << 30);
const HOOK_INTERRUPT: c_int = 1 << 0;
const HOOK_BLOCK: c_int = 1 << 3;
const HOOK_MEMORY_INVALID: c_int = 0b11_1111 << 4;
const PERMIT_ALL: u32 = 7;
const PERMIT_READ_AND_EXECUTE: u32 = 5;

/// A register of the processor, by Unicorn's number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(i32)]
pub enum Register {
    /// Link register.
    Lr = 10,
    /// Program counter.
    Pc = 11,
    /// Stack pointer.
    Sp = 12,
    /// First argument and result.
    R0 = 66,
    /// Second argument.
    R1 = 67,
    /// Third argument.
    R2 = 68,
    /// Fourth argument.
    R3 = 69,
    /// Saved by the callee, as are those up to R11.
    R4 = 70,
    /// See R4.
    R5 = 71,
    /// See R4.
    R6 = 72,
    /// See R4.
    R7 = 73,
    /// See R4.
    R8 = 74,
    /// See R4.
    R9 = 75,
    /// See R4.
    R10 = 76,
    /// See R4.
    R11 = 77,
    /// Scratch register.
    R12 = 78,
    /// Program status.
    Xpsr = 120,
}

impl Register {
    /// All but the program counter.
    pub const ALL: [Self; 16] = [
        // The program status first: it selects the stack pointer.
        Self::Xpsr,
        Self::R0,
        Self::R1,
        Self::R2,
        Self::R3,
        Self::R4,
        Self::R5,
        Self::R6,
        Self::R7,
        Self::R8,
        Self::R9,
        Self::R10,
        Self::R11,
        Self::R12,
        Self::Sp,
        Self::Lr,
    ];
}

/// Peripherals of the processor.
pub trait Bus {
    /// A read of `size` bytes from a peripheral.
    fn read(&mut self, address: u32, size: u32) -> u32;
    /// A write of `size` bytes to a peripheral.
    fn write(&mut self, address: u32, size: u32, value: u32);
    /// `instructions` instructions from `address` on are about to be executed.
    fn execute(&mut self, address: u32, instructions: u32);
    /// An access to an address where nothing is.
    fn fault(&mut self, address: u32, write: bool);
    /// An exception is left by a branch to `EXC_RETURN`.
    fn exception_return(&mut self);
    /// True if the processor has to stop before the next block.
    fn stops(&self) -> bool;
}

type Engine = *mut c_void;
type MemoryReader = unsafe extern "C" fn(Engine, u64, *mut c_void, u64) -> c_int;

struct Functions {
    close: unsafe extern "C" fn(Engine) -> c_int,
    emu_start: unsafe extern "C" fn(Engine, u64, u64, u64, usize) -> c_int,
    emu_stop: unsafe extern "C" fn(Engine) -> c_int,
    reg_read: unsafe extern "C" fn(Engine, c_int, *mut c_void) -> c_int,
    reg_write: unsafe extern "C" fn(Engine, c_int, *const c_void) -> c_int,
    mem_read: MemoryReader,
    mem_write: unsafe extern "C" fn(Engine, u64, *const c_void, u64) -> c_int,
    mem_map: unsafe extern "C" fn(Engine, u64, u64, u32) -> c_int,
    mmio_map: unsafe extern "C" fn(
        Engine,
        u64,
        u64,
        *const c_void,
        *mut c_void,
        *const c_void,
        *mut c_void,
    ) -> c_int,
    hook_add: unsafe extern "C" fn(
        Engine,
        *mut usize,
        c_int,
        *const c_void,
        *mut c_void,
        u64,
        u64,
    ) -> c_int,
}

/// Argument of the callbacks.
struct Attached<B> {
    bus: B,
    emu_stop: unsafe extern "C" fn(Engine) -> c_int,
    mem_read: MemoryReader,
    counts: BlockCounts,
    first_error: Option<String>,
}

/// A window of the address space that the bus serves.
struct Window<B> {
    base: u32,
    attached: *mut Attached<B>,
}

/// The processor and its peripherals.
pub struct Cpu<B: Bus> {
    engine: Engine,
    functions: Functions,
    attached: *mut Attached<B>,
    windows: Vec<*mut Window<B>>,
    /// Keeps the code of `functions` loaded.
    _library: Library,
}

impl<B: Bus> Cpu<B> {
    /// Loads the emulator from its shared library.
    ///
    /// # Errors
    /// If it can't be loaded or has no Cortex-M4.
    pub fn new(library: &Path, bus: B) -> Result<Self> {
        // SAFETY: the library is Unicorn's; its initialisers have no preconditions.
        let library = unsafe { Library::new(library) }
            .with_context(|| format!("can't load the CPU emulator {}", library.display()))?;
        let functions = Functions::of(&library)?;
        let mut engine: Engine = ptr::null_mut();
        type Open = unsafe extern "C" fn(c_uint, c_uint, *mut Engine) -> c_int;
        type Control = unsafe extern "C" fn(Engine, c_uint, ...) -> c_int;
        // SAFETY: signatures as in `unicorn.h`; the engine is valid after `uc_open` has succeeded.
        unsafe {
            let open: Open = symbol(&library, "uc_open")?;
            let control: Control = symbol(&library, "uc_ctl")?;
            check(
                open(ARCHITECTURE_ARM, MODE_THUMB_M_CLASS, &mut engine),
                "uc_open",
            )?;
            check(control(engine, SET_CPU_MODEL, CORTEX_M4), "uc_ctl")?;
        }
        let attached = Box::into_raw(Box::new(Attached {
            bus,
            emu_stop: functions.emu_stop,
            mem_read: functions.mem_read,
            counts: BlockCounts::default(),
            first_error: None,
        }));
        let cpu = Self {
            engine,
            functions,
            attached,
            windows: Vec::new(),
            _library: library,
        };
        cpu.hook(HOOK_BLOCK, on_block::<B> as *const c_void)?;
        cpu.hook(HOOK_INTERRUPT, on_interrupt::<B> as *const c_void)?;
        cpu.hook(HOOK_MEMORY_INVALID, on_invalid::<B> as *const c_void)?;
        Ok(cpu)
    }

    fn hook(&self, kind: c_int, callback: *const c_void) -> Result<()> {
        let mut handle = 0;
        // SAFETY: the callback has the signature of its kind; `attached` lives as long as the engine.
        let status = unsafe {
            (self.functions.hook_add)(
                self.engine,
                &mut handle,
                kind,
                callback,
                self.attached.cast(),
                1,
                0,
            )
        };
        check(status, "uc_hook_add")
    }

    /// Its peripherals.
    pub fn bus(&mut self) -> &mut B {
        // SAFETY: `attached` is valid until `drop`, and no callback runs while `self` is borrowed here.
        unsafe { &mut (*self.attached).bus }
    }

    /// Maps memory; `writable` is false for flash.
    ///
    /// # Errors
    /// If there is something already.
    pub fn map_memory(&mut self, address: u32, bytes: u32, writable: bool) -> Result<()> {
        let permissions = if writable {
            PERMIT_ALL
        } else {
            PERMIT_READ_AND_EXECUTE
        };
        // SAFETY: the engine is valid.
        let status = unsafe {
            (self.functions.mem_map)(self.engine, address.into(), bytes.into(), permissions)
        };
        check(status, "uc_mem_map")
    }

    /// Maps a window that the bus serves.
    ///
    /// # Errors
    /// If there is something already.
    pub fn map_bus(&mut self, address: u32, bytes: u32) -> Result<()> {
        let window = Box::into_raw(Box::new(Window {
            base: address,
            attached: self.attached,
        }));
        self.windows.push(window);
        // SAFETY: the callbacks have the signatures of `uc_mmio_map`; the window lives as long as the engine.
        let status = unsafe {
            (self.functions.mmio_map)(
                self.engine,
                address.into(),
                bytes.into(),
                on_read::<B> as *const c_void,
                window.cast(),
                on_write::<B> as *const c_void,
                window.cast(),
            )
        };
        check(status, "uc_mmio_map")
    }

    /// Writes to memory.
    ///
    /// # Errors
    /// If there is none.
    pub fn write_memory(&mut self, address: u32, bytes: &[u8]) -> Result<()> {
        // SAFETY: the engine is valid, and so is the slice.
        let status = unsafe {
            (self.functions.mem_write)(
                self.engine,
                address.into(),
                bytes.as_ptr().cast(),
                bytes.len() as u64,
            )
        };
        check(status, "uc_mem_write")
    }

    /// Reads memory.
    ///
    /// # Errors
    /// If there is none.
    pub fn read_memory(&mut self, address: u32, bytes: &mut [u8]) -> Result<()> {
        // SAFETY: the engine is valid, and so is the slice.
        let status = unsafe {
            (self.functions.mem_read)(
                self.engine,
                address.into(),
                bytes.as_mut_ptr().cast(),
                bytes.len() as u64,
            )
        };
        check(status, "uc_mem_read")
    }

    /// Reads a register.
    #[must_use]
    pub fn register(&self, register: Register) -> u32 {
        let mut value = 0_u32;
        // SAFETY: all of these registers are of 32 bits.
        unsafe {
            (self.functions.reg_read)(
                self.engine,
                register as c_int,
                ptr::from_mut(&mut value).cast(),
            );
        }
        value
    }

    /// Writes a register.
    pub fn set_register(&mut self, register: Register, value: u32) {
        // SAFETY: all of these registers are of 32 bits.
        unsafe {
            (self.functions.reg_write)(
                self.engine,
                register as c_int,
                ptr::from_ref(&value).cast(),
            );
        }
    }

    /// Runs from `pc` on until the bus asks for a stop; the address of the next instruction.
    ///
    /// # Errors
    /// If the processor meets an unknown instruction or an unmapped address.
    pub fn run(&mut self, pc: u32) -> Result<u32> {
        // SAFETY: the engine is valid; callbacks use `attached` only while this runs.
        let status = unsafe {
            (self.functions.emu_start)(self.engine, u64::from(pc | 1), u64::from(u32::MAX), 0, 0)
        };
        // SAFETY: as in `bus`.
        let attached = unsafe { &mut *self.attached };
        if let Some(error) = attached.first_error.take() {
            anyhow::bail!("{error}, PC {:#010x}", self.register(Register::Pc));
        }
        ensure!(
            status == 0 || attached.bus.stops(),
            "the processor stops with Unicorn's error {status} at {:#010x}",
            self.register(Register::Pc)
        );
        Ok(self.register(Register::Pc))
    }
}

impl<B: Bus> Drop for Cpu<B> {
    fn drop(&mut self) {
        // SAFETY: closed once; the boxes were made by `Box::into_raw` and no callback runs any more.
        unsafe {
            (self.functions.close)(self.engine);
            drop(Box::from_raw(self.attached));
            for &window in &self.windows {
                drop(Box::from_raw(window));
            }
        }
    }
}

impl Functions {
    fn of(library: &Library) -> Result<Self> {
        // SAFETY: signatures as in `unicorn.h` of version 2.1.
        unsafe {
            Ok(Self {
                close: symbol(library, "uc_close")?,
                emu_start: symbol(library, "uc_emu_start")?,
                emu_stop: symbol(library, "uc_emu_stop")?,
                reg_read: symbol(library, "uc_reg_read")?,
                reg_write: symbol(library, "uc_reg_write")?,
                mem_read: symbol(library, "uc_mem_read")?,
                mem_write: symbol(library, "uc_mem_write")?,
                mem_map: symbol(library, "uc_mem_map")?,
                mmio_map: symbol(library, "uc_mmio_map")?,
                hook_add: symbol(library, "uc_hook_add")?,
            })
        }
    }
}

/// A function of the library.
///
/// # Safety
/// `T` is the function's type.
unsafe fn symbol<T: Copy>(library: &Library, name: &str) -> Result<T> {
    // SAFETY: the caller's promise.
    let symbol = unsafe { library.get::<T>(name.as_bytes()) };
    Ok(*symbol.with_context(|| format!("the CPU emulator has no `{name}`"))?)
}

fn check(status: c_int, function: &str) -> Result<()> {
    ensure!(
        status == 0,
        "{function} fails with Unicorn's error {status}"
    );
    Ok(())
}

fn stop_if_asked<B: Bus>(engine: Engine, attached: &Attached<B>) {
    if attached.bus.stops() || attached.first_error.is_some() {
        // SAFETY: called from a callback of this engine, where that is allowed.
        unsafe { (attached.emu_stop)(engine) };
    }
}

unsafe extern "C" fn on_block<B: Bus>(engine: Engine, address: u64, size: u32, data: *mut c_void) {
    // SAFETY: `data` was set by `hook`, and is not used elsewhere while the processor runs.
    let attached = unsafe { &mut *data.cast::<Attached<B>>() };
    let address = address as u32;
    let count = attached.counts.known(address, size);
    let count = count.unwrap_or_else(|| {
        let mut bytes = vec![0_u8; size as usize];
        // SAFETY: reading memory is allowed in a callback; the slice is valid.
        unsafe {
            (attached.mem_read)(
                engine,
                address.into(),
                bytes.as_mut_ptr().cast(),
                size.into(),
            );
        }
        let count = instructions(&bytes);
        attached.counts.learn(address, size, count);
        count
    });
    attached.bus.execute(address, count);
    stop_if_asked(engine, attached);
}

unsafe extern "C" fn on_interrupt<B: Bus>(engine: Engine, number: u32, data: *mut c_void) {
    /// `EXCP_EXCEPTION_EXIT`: a branch to `EXC_RETURN`.
    const EXCEPTION_EXIT: u32 = 8;
    // SAFETY: as in `on_block`.
    let attached = unsafe { &mut *data.cast::<Attached<B>>() };
    match number {
        EXCEPTION_EXIT => attached.bus.exception_return(),
        _ => attached.first_error = Some(format!("the processor takes the exception {number}")),
    }
    stop_if_asked(engine, attached);
}

unsafe extern "C" fn on_invalid<B: Bus>(
    _: Engine,
    kind: c_int,
    address: u64,
    size: c_int,
    _: i64,
    data: *mut c_void,
) -> bool {
    /// `UC_MEM_WRITE_UNMAPPED` and `UC_MEM_WRITE_PROT`.
    const WRITES: [c_int; 2] = [20, 22];
    // SAFETY: as in `on_block`.
    let attached = unsafe { &mut *data.cast::<Attached<B>>() };
    attached.bus.fault(address as u32, WRITES.contains(&kind));
    if !attached.bus.stops() {
        attached.first_error = Some(format!(
            "access {kind} of {size} bytes to {address:#010x}, where nothing is"
        ));
    }
    false
}

// Accesses don't stop the processor by themselves: Unicorn would do them again. The next block's beginning stops it.

unsafe extern "C" fn on_read<B: Bus>(
    _: Engine,
    offset: u64,
    size: c_uint,
    data: *mut c_void,
) -> u64 {
    // SAFETY: `data` is the window set by `map_bus`; its target is not used elsewhere while the processor runs.
    let (base, attached) = unsafe {
        let window = &*data.cast::<Window<B>>();
        (window.base, &mut *window.attached)
    };
    attached.bus.read(base + offset as u32, size).into()
}

unsafe extern "C" fn on_write<B: Bus>(
    _: Engine,
    offset: u64,
    size: c_uint,
    value: u64,
    data: *mut c_void,
) {
    // SAFETY: as in `on_read`.
    let (base, attached) = unsafe {
        let window = &*data.cast::<Window<B>>();
        (window.base, &mut *window.attached)
    };
    attached.bus.write(base + offset as u32, size, value as u32);
}
