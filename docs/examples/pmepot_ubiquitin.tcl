# pmepot_ubiquitin.tcl: two states of ubiquitin, PMEPot's potential of each, the difference on the surface, a picture.
#
# Run in VMD, with ubq.psf and ubq.pdb in the current folder or in the one that the environment variable UBQ names:
#   vmd -e pmepot_ubiquitin.tcl
# The second state is ubiquitin at low pH (every carboxylate takes up a proton's charge) with its tail bent by 20 degrees.

package require pmepot
package require espdiff

set folder [expr {[info exists env(UBQ)] ? $env(UBQ) : [pwd]}]
set picture [expr {[info exists env(UBQ_PICTURE)] ? $env(UBQ_PICTURE) : "ubiquitin_difference.tga"}]

proc load_ubiquitin {folder name} {
    set mol [mol new [file join $folder ubq.psf] type psf waitfor all]
    mol addfile [file join $folder ubq.pdb] type pdb waitfor all $mol
    mol rename $mol $name
    return $mol
}

# A proton's charge, shared by the two oxygens of each carboxylate.
proc neutralize_acids {mol} {
    set oxygens [atomselect $mol "(resname ASP and name OD1 OD2) or (resname GLU and name OE1 OE2)"]
    set charges {}
    foreach charge [$oxygens get charge] { lappend charges [expr {$charge + 0.5}] }
    $oxygens set charge $charges
    $oxygens delete
}

# Turns residues 73 to 76 about the axis through the alpha carbons of 71 and 72.
proc bend_tail {mol degrees} {
    foreach residue {71 72} {
        set atom [atomselect $mol "name CA and resid $residue"]
        set at($residue) [lindex [$atom get {x y z}] 0]
        $atom delete
    }
    set tail [atomselect $mol "resid 73 to 76"]
    $tail move [trans bond $at(71) $at(72) $degrees deg]
    $tail delete
}

# PMEPot loads its map into the top molecule, whatever its option -loadmol says.
proc potential {mol} {
    mol top $mol
    pmepot -mol $mol -grid 1.0 -ewaldfactor 0.25 -loadmol same
}

proc main {folder picture} {
    set neutral [load_ubiquitin $folder "ubiquitin, neutral pH"]
    set acid [load_ubiquitin $folder "ubiquitin, low pH"]
    neutralize_acids $acid
    bend_tail $acid 20
    potential $neutral
    potential $acid

    set comparison [espdiff compare [list mol $neutral map 0] [list mol $acid map 0]]
    puts [espdiff table $comparison]

    mol top $acid
    mol off $neutral
    mol modstyle 0 $acid NewCartoon
    display resetview
    espdiff draw $comparison -color difference
    display update
    render snapshot $picture
    puts "wrote $picture"
}

main $folder $picture
