# ensemble_frames.tcl: frames of VMD's molecules for a running ensemble, one at a time, as it asks for them.

namespace eval ::espdiff {
    # A replicate of the core, and where its frames are: structure (of vmd_structure), frames, and once it is needed
    # `everything`, the structure of all atoms.
    proc vmd_replicate {replicate all_frames role} {
        set mol [vmd_molecule_id [dict get $replicate mol] $role]
        vmd_frame $mol last $role
        set text [value_or $replicate frames $all_frames]
        set frames [vmd_frames $mol $text "$role: frames"]
        set endpoint [dict merge [dict remove $replicate frames label] [list mol $mol frame [lindex $frames 0]]]
        set structure [vmd_structure $endpoint $role]
        vmd_require_charges $structure $role
        set name [molinfo $mol get name]
        set core [dict create name [value_or $replicate label [file rootname $name]] n_frames [llength $frames] \
            origin "molecule $mol ($name), frames $text, [dict get $structure sel]" \
            sha256 [fingerprint_of_frames $structure $frames]]
        return [list $core [dict create structure $structure frames $frames]]
    }

    # SHA-256 of the atoms and of all frames' coordinates.
    proc fingerprint_of_frames {structure frames} {
        set mol [dict get $structure mol]
        set sum [core::chain_sha256 "" [encoding convertto utf-8 [list [dict get $structure atoms] \
            [dict get $structure indices]]]]
        foreach frame $frames { set sum [core::chain_sha256 $sum [gettimestep $mol $frame]] }
        return $sum
    }

    # The molecule of the first replicate in VMD; empty if there is none.
    proc first_molecule {places} {
        set first [lindex [dict keys $places] 0]
        if {$first eq ""} { return "" }
        return [dict get $places $first structure mol]
    }

    # Gives the run the frame that it waits for. What fails here fails as the frame does.
    proc serve_frames {handle places} {
        set wanted [core::ensemble_wanted $handle]
        if {$wanted eq ""} return
        if {[catch { give_frame $handle [dict get $places [dict get $wanted replicate]] $wanted } message error]} {
            set code [dict get $error -errorcode]
            core::ensemble_refuse $handle $message [expr {[lindex $code 0] eq "ESPDIFF" ? [lindex $code 1] : "INTERNAL"}]
        }
    }

    proc give_frame {handle place wanted} {
        set structure [dict get $place structure]
        set mol [dict get $structure mol]
        if {$mol ni [molinfo list]} { fail "molecule $mol was deleted during the run" }
        set frame [lindex [dict get $place frames] [dict get $wanted frame]]
        set endpoint [vmd_with_frame $structure $frame]
        if {![dict get $wanted everything]} { core::ensemble_frame $handle $endpoint; return }
        set all [vmd_with_frame [vmd_structure [list mol $mol frame $frame sel all] "molecule $mol"] $frame]
        core::ensemble_frame $handle $endpoint [dict remove $all cell] [dict get $all cell]
    }
}
