# What is accepted does not fall: some of the commands that the campaigns draw, those that once fell
# among them. All of them: gaitctl campaign sim/campaigns/walks.yaml, footsteps.yaml, footsteps-apart.yaml.
source "$(dirname "$0")/common.sh"
cd "$scratch"

# some NAME SEEDS: the campaign of that name with these seeds only.
some() {
  sed "s/^seeds: .*/seeds: [$2]/; s#commands/#$GAITD_SOURCE/sim/campaigns/commands/#g" \
    "$GAITD_SOURCE/sim/campaigns/$1.yaml" >"$1.yaml"
  gaitctl --json campaign "$1.yaml" -o "$1" >"$1.json" || fail "$1: $(cat "$1/summary.txt")"
}
some walks '6, 10'
some footsteps '1, 3, 7, 31'  # 21 falls with bent knees: docs/decisions/step-plan.md
some footsteps-apart '5, 7'  # 5: all are accepted; 7: fell where they were
# Not because everything is refused.
for name in walks footsteps footsteps-apart; do
  accepted=$(awk -F'"' '/"runs":/ { r += substr($3, 3) } /"refusals":/ { r -= substr($3, 3) }
                        END { print r }' <(sed -n '/"cells"/,/\]/p' "$name.json"))
  ((accepted > 0)) || fail "$name: everything was refused"
done
