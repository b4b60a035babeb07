#!/bin/sh
# The pictures of the README and the manual: docs/pictures/make.sh [CONDYLE]
#
# What each is after: spine, neck and lumbar, hand, knee, arm and shoulder are what the plates and Figure 5 of Shao &
# Ng-Thow-Hing 2003 show, on models of our own; shoulder-shao2003 and spine-shao2003 are the paper's.
set -eu
condyle=${1:-target/release/condyle}
here=$(dirname "$0")

"$condyle" render human --view front --view side --view back --view 35,12 --size 1000x540 -o "$here/human.png"
"$condyle" render human --pose "$here/shoulder.json" --view back --at scapula_r,scapula_l,humerus_r --zoom 2.6 --size 1000x330 -o "$here/shoulder.png"
"$condyle" render spine --pose "$here/spine.json" --view 60,8 --at vt6 --zoom 1.9 --size 1200x380 -o "$here/spine.png"
"$condyle" render human --pose "$here/knee.json" --view side --at knee_r --zoom 5 --show bones,centres --size 1200x360 -o "$here/knee.png"
"$condyle" render human --pose "$here/arm.json" --view back --at scapula_r,scapula_l,humerus_r --zoom 2.6 --size 1000x1000 -o "$here/arm.png"
"$condyle" render human --pose "$here/hand.json" --view -50,30 --at hand_r,index_distal_r,little_distal_r,thumb_distal_r --zoom 10 --size 1200x280 -o "$here/hand.png"
"$condyle" render human --pose "$here/neck.json" --view 40,8 --at skull,vt2 --size 1200x330 -o "$here/neck.png"
"$condyle" render human --pose "$here/lumbar.json" --view 120,8 --at lumbar --size 1200x380 -o "$here/lumbar.png"
"$condyle" render human --pose "$here/foot.json" --view 40,20 --at calcaneus_r,toes_r --zoom 6 --size 1200x330 -o "$here/foot.png"
"$condyle" render human --view 20,10 --at shoulder_r --zoom 3 --show bones,limits --size 700x480 -o "$here/cone.png"
"$condyle" render shoulder --view back --at scapula_r --zoom 1.2 --show bones,contacts --size 700x480 -o "$here/contact.png"
"$condyle" render spine-shao2003 --view side --view front --size 700x420 -o "$here/spine-shao2003.png"
"$condyle" render shoulder-shao2003 --view 20,10 --show bones,limits,contacts --size 700x420 -o "$here/shoulder-shao2003.png"

# Motions in the manner of Figures 13 and 14 of Herda et al. 2003: an arm through the thorax, an arm too far back.
work=$(mktemp -d)
for motion in through-thorax:front too-far-back:side; do
    name=${motion%:*}
    view=${motion#*:}
    "$condyle" convert "$here/$name.json" "$work/$name.mot" --model human --rate 60
    "$condyle" constrain human "$work/$name.mot" -o "$work/$name-legal.mot"
    for which in "" -legal; do
        "$condyle" render human "$work/$name$which.mot" --sheet 6 --limits off --view "$view" --at humerus_r,thorax,hand_r --zoom 1.35 --size 1200x280 -o "$here/$name$which.png"
    done
done
rm -r "$work"
