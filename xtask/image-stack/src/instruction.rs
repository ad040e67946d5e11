//! Thumb instructions as far as the stack and the flow of control are concerned.

use anyhow::{Context, Result, bail, ensure};
use capstone::Capstone;
use capstone::arch::arm::{
    ArchExtraMode, ArchMode, ArmCC, ArmInsn, ArmInsnDetail, ArmOperand, ArmOperandType, ArmReg,
};
use capstone::arch::{BuildsCapstone, BuildsCapstoneExtraMode, DetailsArchInsn};
use capstone::{Insn, RegId};

const STACK_POINTER: RegId = RegId(ArmReg::ARM_REG_SP as u16);
const PROGRAM_COUNTER: RegId = RegId(ArmReg::ARM_REG_PC as u16);
const LINK: RegId = RegId(ArmReg::ARM_REG_LR as u16);
const FRAME_POINTER: RegId = RegId(ArmReg::ARM_REG_R7 as u16);
const WORD_BYTES: i32 = 4;

/// Where control goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Flow {
    /// To the next instruction.
    On,
    /// To an address, in this function or as another one's tail call.
    Jump(u32),
    /// Through a table of offsets, bytes or half-words, that follows the instruction.
    Table { entry_bytes: usize },
    /// To a function and back.
    Call(u32),
    /// To a function whose address is in a register, and back.
    CallByAddress,
    /// The same, without coming back here.
    JumpByAddress,
    /// To the caller.
    Return,
    /// Nowhere: the instruction is one that faults.
    Nowhere,
}

/// What decides whether an instruction is carried out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Condition {
    /// The flags: one of seven tests of them, and what it has to come to.
    Flags(Outcome),
    /// A register, which is compared with zero.
    Register,
}

/// What a test of the flags comes to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Outcome {
    /// Which test: opposite conditions share theirs.
    pub test: u32,
    /// What it comes to.
    pub holds: bool,
}

/// What an instruction does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Instruction {
    /// Where it is.
    pub address: u32,
    /// Bytes of it.
    pub length: u32,
    /// Where control goes.
    pub flow: Flow,
    /// If there is one and it doesn't hold, control goes on to the next instruction and nothing else happens.
    pub condition: Option<Condition>,
    /// It may change the flags.
    pub sets_flags: bool,
    /// Bytes by which the stack gets deeper.
    pub deeper: i32,
    /// The frame pointer gets the stack pointer and that many bytes.
    pub frame_pointer: Option<i32>,
    /// It belongs to the floating-point unit.
    pub floating: bool,
}

/// Decodes the instructions of the Cortex-M4.
pub struct Decoder(Capstone);

impl Decoder {
    /// A decoder.
    pub fn new() -> Result<Self> {
        let decoder = Capstone::new().arm().mode(ArchMode::Thumb);
        let decoder = decoder.extra_mode([ArchExtraMode::MClass].into_iter());
        let built = decoder.detail(true).build();
        built
            .map(Self)
            .context("the decoder of instructions doesn't start")
    }

    /// All instructions of a piece of code; an error if one isn't known.
    pub fn decode(&self, code: &[u8], address: u32) -> Result<Vec<Instruction>> {
        let decoded = self.0.disasm_all(code, u64::from(address))?;
        let instructions: Vec<Instruction> = decoded
            .iter()
            .map(|instruction| self.one(instruction))
            .collect::<Result<_>>()?;
        let end = instructions
            .last()
            .map_or(address, |last| last.address + last.length);
        ensure!(
            end as usize == address as usize + code.len(),
            "what is at {end:#x} is no instruction that is known"
        );
        Ok(instructions)
    }

    fn one(&self, instruction: &Insn<'_>) -> Result<Instruction> {
        let detail = self.0.insn_detail(instruction)?;
        let arch = detail.arch_detail();
        let arm = arch.arm().context("no details")?;
        let parts = Parts {
            kind: ArmInsn::from(instruction.id().0),
            arm,
            operands: arm.operands().collect(),
        };
        let named = || {
            let (name, operands) = (instruction.mnemonic(), instruction.op_str());
            format!(
                "`{} {}` at {:#x}",
                name.unwrap_or("?"),
                operands.unwrap_or(""),
                instruction.address()
            )
        };
        let (deeper, flow) = parts
            .deeper()
            .and_then(|deeper| Ok((deeper, parts.flow()?)))
            .with_context(named)?;
        Ok(Instruction {
            address: u32::try_from(instruction.address())?,
            length: u32::try_from(instruction.len())?,
            flow,
            condition: parts.condition(),
            sets_flags: parts.sets_flags(),
            deeper,
            frame_pointer: parts.frame_pointer(),
            // All of its instructions, and no others, begin like this.
            floating: instruction
                .mnemonic()
                .is_some_and(|name| name.starts_with('v')),
        })
    }
}

fn register_of(operand: &ArmOperand) -> Option<RegId> {
    match operand.op_type {
        ArmOperandType::Reg(register) => Some(register),
        _ => None,
    }
}

struct Parts<'a> {
    kind: ArmInsn,
    arm: &'a ArmInsnDetail<'a>,
    operands: Vec<ArmOperand>,
}

impl Parts<'_> {
    fn register(&self, index: usize) -> Option<RegId> {
        register_of(self.operands.get(index)?)
    }

    fn immediate(&self) -> Option<i32> {
        self.operands
            .iter()
            .find_map(|operand| match operand.op_type {
                ArmOperandType::Imm(value) => Some(value),
                _ => None,
            })
    }

    fn registers(&self) -> impl Iterator<Item = RegId> {
        self.operands.iter().filter_map(register_of)
    }

    fn condition(&self) -> Option<Condition> {
        use ArmInsn::{ARM_INS_CBNZ, ARM_INS_CBZ};
        if matches!(self.kind, ARM_INS_CBZ | ARM_INS_CBNZ) {
            return Some(Condition::Register);
        }
        match self.arm.cc() {
            ArmCC::ARM_CC_AL | ArmCC::ARM_CC_INVALID => None,
            // Opposite conditions follow each other: EQ NE, HS LO, MI PL, VS VC, HI LS, GE LT, GT LE.
            condition => {
                let number = condition as u32 - ArmCC::ARM_CC_EQ as u32;
                Some(Condition::Flags(Outcome {
                    test: number / 2,
                    holds: number.is_multiple_of(2),
                }))
            }
        }
    }

    fn sets_flags(&self) -> bool {
        use ArmInsn::{ARM_INS_CMN, ARM_INS_CMP, ARM_INS_TEQ, ARM_INS_TST};
        let compares = matches!(
            self.kind,
            ARM_INS_CMP | ARM_INS_CMN | ARM_INS_TST | ARM_INS_TEQ
        );
        compares || self.arm.update_flags()
    }

    /// How much memory operand `[sp, #n]!` or `[sp], #n` moves the stack pointer.
    fn written_back(&self) -> Option<i32> {
        let memory = self
            .operands
            .iter()
            .find_map(|operand| match operand.op_type {
                ArmOperandType::Mem(memory) if memory.base() == STACK_POINTER => Some(memory),
                _ => None,
            })?;
        let behind = self.immediate().unwrap_or(0);
        self.arm.writeback().then_some(memory.disp() + behind)
    }

    /// Bytes of the registers among the operands that are saved or restored: a word each, or two of a double one.
    fn saved_bytes(&self) -> Result<i32> {
        use ArmReg::{ARM_REG_D0, ARM_REG_D31, ARM_REG_R0, ARM_REG_R12, ARM_REG_S0, ARM_REG_S31};
        let is_in = |register: RegId, first: ArmReg::Type, last: ArmReg::Type| {
            (first..=last).contains(&ArmReg::Type::from(register.0))
        };
        let of_one = |register: RegId| match register {
            STACK_POINTER => Ok(0),
            LINK | PROGRAM_COUNTER => Ok(WORD_BYTES),
            _ if is_in(register, ARM_REG_R0, ARM_REG_R12) => Ok(WORD_BYTES),
            _ if is_in(register, ARM_REG_S0, ARM_REG_S31) => Ok(WORD_BYTES),
            _ if is_in(register, ARM_REG_D0, ARM_REG_D31) => Ok(2 * WORD_BYTES),
            _ => bail!("saves a register that isn't known"),
        };
        self.registers().map(of_one).sum()
    }

    /// Bytes by which the stack gets deeper; an error if that can't be told.
    fn deeper(&self) -> Result<i32> {
        use ArmInsn::{
            ARM_INS_ADD, ARM_INS_ADDW, ARM_INS_LDM, ARM_INS_LDMDB, ARM_INS_POP, ARM_INS_PUSH,
            ARM_INS_STM, ARM_INS_STMDB, ARM_INS_SUB, ARM_INS_SUBW, ARM_INS_VLDMDB, ARM_INS_VLDMIA,
            ARM_INS_VPOP, ARM_INS_VPUSH, ARM_INS_VSTMDB, ARM_INS_VSTMIA,
        };
        match self.kind {
            ARM_INS_PUSH | ARM_INS_VPUSH => return self.saved_bytes(),
            ARM_INS_POP | ARM_INS_VPOP => return Ok(-self.saved_bytes()?),
            _ => {}
        }
        if let Some(moved) = self.written_back() {
            return Ok(-moved);
        }
        if self.register(0) != Some(STACK_POINTER) || self.is_read_only() {
            return Ok(0);
        }
        let by_itself = self.operands.len() == 2 || self.register(1) == Some(STACK_POINTER);
        let moves = self.arm.writeback();
        match (self.kind, self.immediate()) {
            (ARM_INS_SUB | ARM_INS_SUBW, Some(bytes)) if by_itself => Ok(bytes),
            (ARM_INS_ADD | ARM_INS_ADDW, Some(bytes)) if by_itself => Ok(-bytes),
            (ARM_INS_STMDB | ARM_INS_VSTMDB, _) if moves => self.saved_bytes(),
            (ARM_INS_LDM | ARM_INS_VLDMIA, _) if moves => Ok(-self.saved_bytes()?),
            (ARM_INS_STM | ARM_INS_VSTMIA | ARM_INS_LDMDB | ARM_INS_VLDMDB, _) if moves => {
                bail!("uses the stack upside down")
            }
            (ARM_INS_STMDB | ARM_INS_VSTMDB | ARM_INS_LDM | ARM_INS_VLDMIA, _)
            | (ARM_INS_STM | ARM_INS_VSTMIA | ARM_INS_LDMDB | ARM_INS_VLDMDB, _) => Ok(0),
            _ => bail!("moves the stack pointer in a way that can't be followed"),
        }
    }

    /// Comparisons and stores have no result among their operands.
    fn is_read_only(&self) -> bool {
        use ArmInsn::{ARM_INS_CMN, ARM_INS_CMP, ARM_INS_MSR, ARM_INS_STR, ARM_INS_TST};
        matches!(
            self.kind,
            ARM_INS_CMP | ARM_INS_CMN | ARM_INS_TST | ARM_INS_STR | ARM_INS_MSR
        )
    }

    fn flow(&self) -> Result<Flow> {
        use ArmInsn::{
            ARM_INS_B, ARM_INS_BL, ARM_INS_BLX, ARM_INS_BX, ARM_INS_CBNZ, ARM_INS_CBZ, ARM_INS_LDM,
            ARM_INS_POP, ARM_INS_TBB, ARM_INS_TBH, ARM_INS_UDF,
        };
        let target = || {
            let target = self.immediate().context("a branch without a target")?;
            Ok::<_, anyhow::Error>(target.cast_unsigned())
        };
        let first = self.register(0);
        Ok(match self.kind {
            ARM_INS_B | ARM_INS_CBZ | ARM_INS_CBNZ => Flow::Jump(target()?),
            ARM_INS_BL => Flow::Call(target()?),
            ARM_INS_BLX => Flow::CallByAddress,
            ARM_INS_BX if first == Some(LINK) => Flow::Return,
            ARM_INS_BX => Flow::JumpByAddress,
            ARM_INS_TBB => Flow::Table { entry_bytes: 1 },
            ARM_INS_TBH => Flow::Table { entry_bytes: 2 },
            ARM_INS_UDF => Flow::Nowhere,
            _ if !self.registers().any(|register| register == PROGRAM_COUNTER) => Flow::On,
            ARM_INS_POP => Flow::Return,
            ARM_INS_LDM if first == Some(STACK_POINTER) => Flow::Return,
            _ if self.written_back().is_some() => Flow::Return,
            ARM_INS_LDM => bail!("goes where can't be told"),
            _ if first == Some(PROGRAM_COUNTER) => bail!("goes where can't be told"),
            // What is left computes an address from it.
            _ => Flow::On,
        })
    }

    /// `mov r7, sp` and `add r7, sp, #n`.
    fn frame_pointer(&self) -> Option<i32> {
        use ArmInsn::{ARM_INS_ADD, ARM_INS_ADDW, ARM_INS_MOV};
        let from_stack = self.register(0) == Some(FRAME_POINTER)
            && self.register(1) == Some(STACK_POINTER)
            && matches!(self.kind, ARM_INS_ADD | ARM_INS_ADDW | ARM_INS_MOV);
        from_stack.then(|| self.immediate().unwrap_or(0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn decoded(halves: &[u16]) -> Result<Vec<Instruction>> {
        let code: Vec<u8> = halves.iter().flat_map(|half| half.to_le_bytes()).collect();
        Decoder::new()?.decode(&code, 0x0800_0000)
    }

    #[test]
    fn a_prologue_and_its_epilogue_cancel() {
        let code = [
            0xB5F0, // push {r4, r5, r6, r7, lr}
            0xAF03, // add r7, sp, #12
            0xF84D, 0xBD04, // str r11, [sp, #-4]!
            0xB082, // sub sp, #8
            0xF5AD, 0x5D54, // sub.w sp, sp, #13568
            0xF50D, 0x5D54, // add.w sp, sp, #13568
            0xB002, // add sp, #8
            0xF85D, 0xBB04, // ldr r11, [sp], #4
            0xBDF0, // pop {r4, r5, r6, r7, pc}
        ];
        let instructions = decoded(&code).unwrap();
        let moves: Vec<i32> = instructions.iter().map(|one| one.deeper).collect();
        assert_eq!(moves, [20, 0, 4, 8, 13_568, -13_568, -8, -4, -20]);
        assert_eq!(instructions[1].frame_pointer, Some(12));
        assert_eq!(instructions.last().unwrap().flow, Flow::Return);
        assert!(instructions[..8].iter().all(|one| one.flow == Flow::On));
    }

    #[test]
    fn a_condition_before_a_return_is_seen() {
        let code = [
            0xBF08, // it eq
            0x4770, // bxeq lr
            0x4770, // bx lr
        ];
        let instructions = decoded(&code).unwrap();
        let equal = Condition::Flags(Outcome {
            test: 0,
            holds: true,
        });
        assert_eq!(instructions[1].condition, Some(equal));
        assert_eq!(instructions[1].flow, Flow::Return);
        assert_eq!(instructions[2].condition, None);
    }

    #[test]
    fn calls_and_jumps_have_their_targets() {
        let code = [
            0xF7FF, 0xFFFE, // bl 0x8000000
            0x47B0, // blx r6
            0x4718, // bx r3
            0xE8DF, 0xF000, // tbb [pc, r0]
            0xB108, // cbz r0, +2
            0xDE00, // udf
        ];
        let flows: Vec<Flow> = decoded(&code).unwrap().iter().map(|one| one.flow).collect();
        let expected = [
            Flow::Call(0x0800_0000),
            Flow::CallByAddress,
            Flow::JumpByAddress,
            Flow::Table { entry_bytes: 1 },
            Flow::Jump(0x0800_0012),
            Flow::Nowhere,
        ];
        assert_eq!(flows, expected);
    }

    #[test]
    fn what_cannot_be_followed_is_refused() {
        assert!(decoded(&[0x468D]).is_err(), "mov sp, r1");
        assert!(decoded(&[0x4687]).is_err(), "mov pc, r0");
        assert!(decoded(&[0xEBAD, 0x0D01]).is_err(), "sub sp, sp, r1");
    }

    #[test]
    fn saved_floating_point_registers_make_the_stack_deeper() {
        let code = [
            0xED2D, 0x8B04, // vpush {d8, d9}
            0xED2D, 0x8A01, // vpush {s16}
            0xED8D, 0x0A01, // vstr s0, [sp, #4]
            0xEC8D, 0x0A02, // vstmia sp, {s0, s1}
            0xECB0, 0x0A02, // vldmia r0!, {s0, s1}
            0xEEB8, 0x0A40, // vcvt.f32.u32 s0, s0
            0xECBD, 0x8A01, // vpop {s16}
            0xECBD, 0x8B04, // vpop {d8, d9}
        ];
        let instructions = decoded(&code).unwrap();
        let moves: Vec<i32> = instructions.iter().map(|one| one.deeper).collect();
        assert_eq!(moves, [16, 4, 0, 0, 0, 0, -4, -16]);
        assert!(instructions.iter().all(|one| one.floating));
        assert!(instructions.iter().all(|one| one.flow == Flow::On));
        assert!(
            decoded(&[0xECAD, 0x0A02]).is_err(),
            "vstmia sp!, {{s0, s1}}"
        );
    }

    #[test]
    fn floating_point_is_seen() {
        let instructions = decoded(&[0xEE30, 0x0A20]).unwrap();
        assert!(instructions[0].floating, "vadd.f32 s0, s0, s1");
    }
}
