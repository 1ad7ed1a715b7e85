# prepare_form.tcl: the row that offers charges for a molecule of VMD that has none.

namespace eval ::espdiff::gui {
    variable preparing ""             ;# handle of the running preparation
    variable to_prepare {}   ;# sides that are prepared next, before they are compared
    variable compares_next 0 ;# whether the last preparation is followed by the comparison

    proc build_prepare_row {path side} {
        variable widget
        ttk::frame $path.charges
        ttk::label $path.charges.text -foreground #8a5a00
        ttk::button $path.charges.prepare -text Prepare... -width 0 \
            -command [list ::espdiff::gui::guard ::espdiff::gui::choose_prepared $side]
        tip $path.charges.prepare "Add hydrogens, charges and radii by PDB2PQR, by the force field and the pH on the\
            settings' page Input, and load the result beside this molecule"
        pack $path.charges.text -side left
        pack $path.charges.prepare -side right
        grid $path.charges -row 8 -column 0 -columnspan 3 -sticky ew -pady {4 0}
        set widget($side,charges) $path.charges
        set widget($side,charges_text) $path.charges.text
        set widget($side,prepare) $path.charges.prepare
        grid remove $path.charges
    }

    # Shown for a molecule without charges.
    proc update_prepare_row {side} {
        variable form
        variable widget
        variable preparing
        set mol [number_of $form($side,mol)]
        set lacks [expr {$form($side,kind) eq "mol" && $mol ne "" && ![has_charges $mol]}]
        show_if $lacks $widget($side,charges)
        if {!$lacks} return
        $widget($side,charges_text) configure -text "No charges in [file_types $mol]"
        set_enabled [expr {$preparing eq ""}] $widget($side,prepare)
    }

    proc has_charges {mol} {
        set atoms [atomselect $mol all]
        set charges [$atoms get charge]
        $atoms delete
        foreach charge $charges { if {$charge != 0} { return 1 } }
        return 0
    }

    proc file_types {mol} {
        set types {}
        foreach type [lindex [molinfo $mol get filetype] 0] { lappend types [string toupper $type] }
        return [join [lsort -unique $types] ", "]
    }

    # Asks for the file that is written.
    proc choose_prepared {side} {
        variable window
        variable form
        set mol [number_of $form($side,mol)]
        set name [file rootname [molinfo $mol get name]]-prepared.pqr
        set path [tk_getSaveFile -parent $window -initialfile $name -defaultextension .pqr \
            -filetypes {{"PQR structures" .pqr} {"All files" *}}]
        if {$path ne ""} { start_preparation $side $path }
    }

    # The sides whose molecules have no charges and would get a computed potential.
    proc unprepared_sides {} {
        variable form
        set sides {}
        foreach side {source target} {
            set mol [number_of $form($side,mol)]
            if {$form($side,kind) ne "mol" || $mol eq "" || ![is_computed_map [string trim $form($side,map)]]} continue
            if {$mol in [molinfo list] && ![has_charges $mol]} { lappend sides $side }
        }
        return $sides
    }

    # Molecules without charges: asks whether to prepare them, compare, and draw. Returns whether the answer takes the
    # place of the comparison.
    proc offer_preparation {} {
        variable form
        variable window
        variable to_prepare
        variable compares_next
        set sides [expr {[in_vmd] ? [unprepared_sides] : {}}]
        if {$sides eq "" || [dict get [::espdiff::core::build] pdb2pqr] eq ""} { return 0 }
        foreach side $sides {
            lappend names $form($side,mol)
            lappend paths [file tail [prepared_path $side]]
        }
        set names [::espdiff::join_words [lsort -unique $names] and]
        set paths [::espdiff::join_words [lsort -unique $paths] and]
        set answer [tk_messageBox -parent $window -type yesnocancel -icon question \
            -title "Surface Potential Comparison" -message "No charges: $names" \
            -detail "Prepare by PDB2PQR (hydrogens, charges and radii, by the settings' page Input), compare, and\
                draw? This saves and loads $paths in the folder\
                [file dirname [prepared_path [lindex $sides 0]]].\n\nNo compares the shapes alone."]
        if {$answer eq "cancel"} { return 1 }
        if {$answer ne "yes"} { return 0 }
        set to_prepare $sides
        set compares_next 1
        prepare_next
        return 1
    }

    # Prepares the next side of those to come; after the last one compares and draws.
    proc prepare_next {} {
        variable to_prepare
        variable compares_next
        variable draw_when_done
        if {$to_prepare ne ""} {
            set to_prepare [lassign $to_prepare side]
            start_preparation $side [prepared_path $side]
        } elseif {$compares_next} {
            set compares_next 0
            set draw_when_done [start_compare [endpoint source] [endpoint target] [setting_options]]
        }
    }

    # A new name in the working folder, where VMD's own tools write, or beside the molecule's file if nothing can be
    # written there.
    proc prepared_path {side} {
        variable form
        set mol [number_of $form($side,mol)]
        set folder [pwd]
        if {![file writable $folder]} {
            set folder [file dirname [file normalize [lindex [molinfo $mol get filename] 0 0]]]
        }
        set name [file join $folder [file rootname [file tail [molinfo $mol get name]]]-prepared]
        set path $name.pqr
        for {set i 2} {[file exists $path]} {incr i} { set path $name-$i.pqr }
        return $path
    }

    # Prepares the side's molecule in the background, into a free file or one that the dialog has asked about.
    proc start_preparation {side path} {
        variable running
        variable preparing
        variable prepared
        if {$running ne ""} { error "a computation is running; wait for it, or cancel it" }
        set words [list prepare [dict remove [molecule_endpoint $side] map] -pqr $path -overwrite 1 \
            {*}[setting_options preparation]]
        set running [espdiff {*}$words -progress ::espdiff::gui::show_progress \
            -command [list ::espdiff::gui::guard ::espdiff::gui::finish_preparation $side]]
        set preparing $running
        dict set prepared $path $words
        save_settings
        show_message "Preparing..."
        show_running 1
        update_prepare_row $side
        watch
        return $running
    }

    # The PQR takes the molecule's place in the form: loaded, or as a file where VMD would misread it.
    proc finish_preparation {side handle} {
        variable running
        variable preparing
        variable compares_next
        variable form
        if {$handle ne $running} return
        end_run
        set preparing ""
        update_prepare_row $side
        if {[catch_labelled { espdiff wait $handle } message options]} {
            forget_preparations
            espdiff delete $handle
            set cancelled [expr {[lindex [dict get $options -errorcode] 1] eq "CANCELLED"}]
            if {$cancelled} { show_message "Cancelled." } else { show_message $message error }
            return
        }
        set result [espdiff result $handle]
        espdiff delete $handle
        set words [preparation_words [dict get $result preparation]]
        if {[dict get $result fits_pdb_columns]} {
            show_prepared $side [dict get $result file]
        } else {
            array set form [list $side,kind file $side,file [dict get $result file]]
            append words "; VMD reads no names as long as the file's, so that the file is chosen instead of a molecule"
        }
        foreach other {source target} { update_endpoint $other }
        show_message $words
        if {$compares_next} { vmdcon -info "espdiff) $words" }  ;# the comparison's messages follow
        prepare_next
    }

    proc show_prepared {side path} {
        variable form
        set top [molinfo top]
        set mol [mol new $path type pqr waitfor all]
        if {$top ne ""} { mol top $top }
        mol off [number_of $form($side,mol)]  ;# the prepared molecule is in the same place
        set form($side,mol) "$mol: [molinfo $mol get name]"
        choose_molecule $side
    }

    # A preparation failed or was cancelled: nothing follows it.
    proc forget_preparations {} {
        variable to_prepare {}
        variable compares_next 0
    }

    # "1686 hydrogens added, net charge -3; HIS 126 of chain A: HIE; ..."
    proc preparation_words {preparation} {
        if {$preparation eq ""} { return "The molecule had charges." }
        set words "[dict get $preparation program]: [dict get $preparation n_hydrogens_added] hydrogens added,\
            net charge [format %.4g [dict get $preparation net_charge]]"
        foreach key {added removed renamed protonation gaps} {
            foreach line [dict get $preparation $key] {
                append words "; [expr {$key in {protonation} ? "" : "[string map {gaps missing} $key] "}]$line"
            }
        }
        return $words
    }
}
