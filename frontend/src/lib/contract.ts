/**
 * The names by which the page knows the station's document and the messages that carry it.
 *
 * All types come from `api.ts`, which is generated from the server's OpenAPI document; nothing is declared here
 * that the server does not declare, apart from what JSON schema cannot say (which fields of a delta are maps).
 */
import type { components, paths } from './api.ts';

/** A path of the document with something in place of each of its parameters. */
type Filled<Path extends string> = Path extends `${infer Before}{${string}}${infer After}`
	? `${Before}${string}${Filled<After>}`
	: Path;
/** The address of a request, with what it asks for behind a question mark. */
export type Address = Filled<keyof paths & string> | `${Filled<keyof paths & string>}?${string}`;

type Schemas = components['schemas'];

export type DraftChanges = Schemas['DraftChangesView'];
export type ExampleStations = Schemas['ExamplesView'];
export type StationView = Schemas['StationView'];
export type Resource = Schemas['ResourceView'];
export type Variable = Schemas['VariableView'];
export type Ability = Schemas['AbilityView'];
export type Operation = Schemas['OperationView'];
export type Job = Schemas['JobView'];
export type Figures = Schemas['FiguresAnswer'];
export type Wall = Schemas['WallAnswer'];
export type Plan = Schemas['PlanView'];
export type Diagnosis = Schemas['DiagnosisView'];
export type PlanStep = Schemas['PlanStepView'];
export type Replacement = Schemas['ReplacementView'];
export type WhyNot = Schemas['WhyNotView'];
export type Condition = Schemas['ConditionView'];
export type ReasonTree = Schemas['ReasonTreeView'];
export type Reason = Schemas['ReasonView'];
export type VariableTrace = Schemas['TraceView'];
export type TracedPipeline = Schemas['TracedPipelineView'];
export type TracedStep = Schemas['TracedStepView'];
export type TracedReader = Schemas['TracedReaderView'];
export type TracedChange = Schemas['TracedChangeView'];
export type Involved = Schemas['InvolvedView'];
export type Changer = Schemas['ChangerView'];
export type AbilityAutomaton = Schemas['AutomatonView'];
export type AbilityDefinition = Schemas['AbilityDefinitionView'];
export type Predicate = Schemas['PredicateView'];
export type Conjunct = Schemas['ConjunctView'];
export type AbilityAction = Schemas['AbilityActionView'];
export type Supervised = Schemas['SupervisedView'];
export type Reaction = Schemas['ReactionView'];
export type Trial = Schemas['TrialView'];
export type TriedReaction = Schemas['TriedReactionView'];
export type StepStatus = Schemas['StepStatus'];
export type Task = Schemas['TaskView'];
export type Instruction = Schemas['InstructionView'];
export type Topic = Schemas['TopicView'];
export type Alarm = Schemas['AlarmView'];
export type Message = Schemas['Message'];
export type Argument = Schemas['Argument'];
export type Item = Schemas['Item'];
export type Analysis = Schemas['AnalysisDocument'];
export type LiftedGuard = Schemas['LiftedGuard'];
export type Trace = Schemas['TraceDocument'];
export type Priority = Schemas['Priority'];
export type Mode = Schemas['Mode'];
export type Standing = Schemas['StationStanding'];
export type ProblemKind = Schemas['ProblemKind'];
export type PackML = Schemas['PackML'];
export type AlarmState = Schemas['AlarmState'];
export type DeploymentOutcome = NonNullable<StationView['deployment']>;
export type Simulation = Schemas['Simulation'];
export type Force = Schemas['ForceView'];
export type OutOfService = Schemas['ServiceView'];
export type Errand = Schemas['OperatorPlanView'];
export type WhoCan = Schemas['WhoCanView'];
export type LastOperatorPlan = Schemas['LastOperatorPlanView'];
export type Question = Schemas['QuestionView'];
export type Approval = Schemas['ApprovalView'];
export type ApprovedAct = Approval['act'];
export type LastCorrection = Schemas['LastCorrectionView'];
export type CorrectionPreview = Schemas['CorrectionPreview'];
export type PlanPreview = Schemas['PlanPreviewView'];
export type Names = Schemas['NamesView'];
export type VariableKind = Schemas['VariableKind'];
export type UndecidedOutput = Schemas['UndecidedOutputView'];
export type AdviceAnswer = Schemas['AdviceView'];
export type WayOffer = Schemas['OfferView'];
export type Value = NonNullable<Variable['value']>;

export type SessionAnswer = Schemas['SessionAnswer'];
export type ProviderBegun = Schemas['BegunAnswer'];
export type ProviderSession = Schemas['ProviderSessionAnswer'];
export type Role = Schemas['Role'];
export type Control = Schemas['ControlView'];
export type Standby = Schemas['StandbyView'];

export type Delta = Schemas['Delta'];
export type StreamMessage = Schemas['StreamMessage'];
export type Resync = Schemas['Resync'];
export type Problem = Schemas['Problem'];
export type TextPlace = Schemas['TextPlace'];

export type Person = Schemas['PersonAnswer'];
export type PeopleAnswer = Schemas['PeopleAnswer'];
export type Key = Schemas['KeyAnswer'];
export type KeysAnswer = Schemas['KeysAnswer'];
export type NewKey = Schemas['NewKeyAnswer'];
export type KeyScope = Schemas['Scope'];
export type JobOrder = Schemas['OrderAnswer'];
export type JobOrders = Schemas['OrdersAnswer'];
export type OrderCommand = Schemas['OrderCommand'];
export type OrderState = Schemas['OrderState'];
export type OrderOfWork = Schemas['OrderOfWorkAnswer'];
export type JobResponse = Schemas['ResponseAnswer'];
export type JobResponses = Schemas['ResponsesAnswer'];
export type Capabilities = Schemas['CapabilitiesAnswer'];
export type Backup = Schemas['BackupAnswer'];
export type Backups = Schemas['BackupsAnswer'];
export type BackupTrouble = Schemas['BackupTroubleAnswer'];
export type Storage = Schemas['StorageAnswer'];
export type Webhook = Schemas['Webhook'];
export type Webhooks = Schemas['WebhooksAnswer'];
export type NewWebhook = Schemas['NewWebhookAnswer'];
export type Watch = Schemas['WatchAnswer'];
export type Offer = Schemas['OfferAnswer'];
export type NewOffer = Schemas['NewOfferAnswer'];
export type WatchesAnswer = Schemas['WatchesAnswer'];
export type WatchSelf = Schemas['WatchSelfAnswer'];
export type WatchStreamMessage = Schemas['WatchStreamMessage'];
export type WatchSnapshot = Schemas['WatchSnapshot'];
export type Actor = Schemas['Actor'];
export type AuditRecord = Schemas['Record'];
export type AuditAnswer = Schemas['AuditAnswer'];
export type Outcome = Schemas['Outcome'];
export type RunRecord = Schemas['RunRecordView'];
export type HistoryAnswer = Schemas['HistoryAnswer'];

export type Network = Schemas['NetworkView'];
export type GraphTopic = Schemas['GraphTopicView'];
export type Endpoint = Schemas['EndpointView'];
export type Quality = Schemas['QualityView'];
export type Mismatch = Schemas['MismatchView'];
export type Call = Schemas['CallView'];

export type TimeLine = Schemas['LineView'];
export type Mark = Schemas['MarkView'];
export type Place = Schemas['PlaceView'];
export type Moment = Schemas['MomentView'];
export type Past = Schemas['PastView'];
export type PastPlan = Schemas['PastPlanView'];
export type Branch = Schemas['BranchView'];
export type BranchBody = Schemas['BranchBody'];
export type WhatIf = Schemas['WhatIfView'];
export type WhatIfBody = Schemas['WhatIfBody'];
export type Steps = Schemas['StepsView'];
export type StepsBody = Schemas['StepsBody'];
export type Step = Schemas['StepView'];
export type Tried = Schemas['SimulationView'];
export type Advance = Schemas['Advance'];
export type TryBody = Schemas['SimulationBody'];
export type Scenarios = Schemas['ScenariosView'];
export type ScenarioRun = Schemas['ScenarioRunView'];
export type ScenarioExpectation = Schemas['ScenarioExpectation'];
export type WrittenScenario = Schemas['WrittenScenarioView'];
export type TriedMoment = Schemas['SimulationMomentView'];
export type TriedModel = Schemas['SimulatedModelView'];
export type Recording = Schemas['RecordedTrafficView'];
export type RecordedState = Schemas['RecordedStateView'];
export type RecordedVariable = Schemas['RecordedVariableView'];
export type RecordedMoment = Schemas['RecordedMomentView'];
export type StepMoment = Schemas['StepMomentView'];
export type StepChoice = Schemas['ChoiceView'];
export type StateSpaceTold = Schemas['StateSpaceView'];
export type StateSpaceQuestion = Schemas['StateSpaceQuestion'];
export type StateSpaceBody = Schemas['StateSpaceBody'];
export type FoldedState = Schemas['FoldedStateView'];
export type StateArrow = Schemas['StateArrowView'];
export type StateCause = Schemas['StateCauseView'];
export type SpaceExtent = Schemas['Extent'];
export type Checkpoint = Schemas['Checkpoint'];

export type FilesView = Schemas['FilesView'];
export type FileMark = Schemas['FileMark'];
export type DraftView = Schemas['DraftView'];
export type FileView = Schemas['FileView'];
export type DraftChange = Schemas['ChangeView'];
export type ModelCheck = Schemas['CheckView'];
export type Fix = Schemas['FixDocument'];
export type Finding = Schemas['FindingDocument'];
export type Usages = Schemas['UsagesView'];
export type Fold = Schemas['FoldView'];
export type Folds = Schemas['FoldsView'];
export type ModelGraph = Schemas['GraphView'];
export type ModelThing = Schemas['ThingView'];
export type ModelTie = Schemas['TieView'];
export type Workshop = Schemas['WorkshopView'];
export type WorkshopMessage = Schemas['WorkshopStreamMessage'];
export type TraceStep = Schemas['StepDocument'];
export type Revision = Schemas['RevisionView'];
export type Revisions = Schemas['RevisionsView'];
export type PlannedDeployment = Schemas['PlannedDeploymentView'];
export type Verdict = Schemas['Verdict'];
export type Comments = Schemas['CommentsView'];
export type Comparison = Schemas['ComparisonView'];
export type PartDifference = Schemas['PartDifference'];
export type BehaviourDifference = Schemas['BehaviourDifference'];
export type PlanDifference = Schemas['PlanDifference'];
export type Transfer = Schemas['TransferView'];
export type Outline = Schemas['Outline'];
export type OutlineView = Schemas['OutlineView'];
export type OutlineProblem = Schemas['OutlineProblem'];
export type Templates = Schemas['TemplatesView'];
export type Edit = Schemas['ChangeBody']['edits'][number];
export type Json = Schemas['JsonValue'];

/** Written as a record, so that the compiler misses the name of a map that is not here. */
const MERGED: Record<keyof Schemas['StationRemoval'], true> = {
	resources: true,
	variables: true,
	abilities: true,
	operations: true,
	jobs: true,
	tasks: true,
	topics: true,
	overrides: true,
	forces: true,
	breakpoints: true,
	undecided: true,
	approvals: true,
	alarms: true
};

/** The fields of the document that are maps: a delta merges into them and `removed` names the keys that are gone. */
export const MAPS = Object.keys(MERGED) as (keyof typeof MERGED)[];

export type DraftPipelines = Schemas['DraftPipelinesView'];
export type DraftPipeline = Schemas['DraftPipelineView'];
export type DraftStage = Schemas['DraftStageView'];
export type DraftEdge = Schemas['DraftEdgeView'];
export type LiveEdge = Schemas['LiveEdgeView'];
export type DraftVariable = Schemas['DraftVariableView'];
export type DraftExample = Schemas['DraftExampleView'];
export type PipelineFits = Schemas['FitsView'];
export type PipelinePreview = Schemas['PreviewView'];
export type StageOffer = Schemas['StageOfferView'];
export type PipelineTarget = Schemas['TargetView'];
export type SourceOffer = Schemas['SourceOfferView'];
export type PipelineRuns = Schemas['RunsView'];
export type PipelineRun = Schemas['RunView'];
export type RunStep = Schemas['RunStepView'];
export type RecordedExample = Schemas['RecordedView'];
export type TypeOfField = Schemas['TypeView'];
export type Flows = Schemas['FlowsView'];
export type EdgeFlow = Schemas['EdgeFlowView'];
export type FlowsMessage = Schemas['FlowsStreamMessage'];
export type Attachment = Schemas['AttachmentAnswer'];

export type Mimic = Schemas['MimicView'];
export type DraftOperations = Schemas['DraftOperationsView'];
export type DraftOperation = Schemas['DraftOperationView'];
export type OperationCondition = Schemas['OperationConditionView'];
export type OperationDefinition = Schemas['OperationDefinitionView'];
export type OperationLink = Schemas['OperationLinkView'];
export type DraftPicture = Schemas['DraftPictureView'];
export type MimicSymbol = Schemas['MimicSymbol'];
export type MimicTrack = Schemas['MimicTrack'];
export type MimicStop = Schemas['MimicStop'];
export type MimicPart = Schemas['MimicPart'];
export type MimicDrawing = Schemas['MimicDrawing'];
export type MimicBound = Schemas['MimicBound'];
export type MimicTest = Schemas['MimicTest'];
export type MimicText = Schemas['MimicText'];
