// this_process.h: this process' number, program, environment and limit of memory, and its place taken by another
// program.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace espdiff {

int process_number();
/// Whether there is a process of that number, whoever's it is.
bool is_process(int number);
/// The file of the running program; empty where it cannot be told.
std::string own_program();
/// Only while there is one thread, or where no other one asks. A value that the user gave is kept.
/// @returns whether there was none
bool set_environment_default(const char* name, const char* value);
/// Runs another program (looked up on PATH without a slash) in place of this one. Returns only if that fails.
/// @param words its name and arguments  @returns the error's number
int become_program(const std::string& program, const std::vector<std::string>& words);

/// The most bytes of addresses that this process may use (`ulimit -v`); UINT64_MAX without a limit.
std::uint64_t address_space_limit();
std::uint64_t memory_page_size();
/// Bytes that anyone in this process allocated and did not give back; exact, but for small blocks that the allocator
/// keeps for each thread. 0 where the C library does not tell.
std::uint64_t allocated_bytes();
/// Gives free memory that the allocator keeps back to the system, where the C library can.
void return_free_memory();
/// Arrays from 32 MB, glibc's limit, get pages of their own from now on, which go back to the system when they are
/// freed; of smaller ones up to 128 MB are kept, because pages that are fetched again at each step take a tenth of a
/// run's time. For a program, not a library: it is the whole process' setting. What the user set by MALLOC_... stays.
void keep_large_arrays_apart();

}  // namespace espdiff
